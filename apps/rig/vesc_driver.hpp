#pragma once

#include <optional>

#include "rig/serial_driver.hpp"
#include "rig/vesc_protocol.hpp"

namespace zwidth::rig {

/// A VESC of firmware 6.00 or newer on its UART, or on a CAN bus: a motor current for the torque, the position modulo a turn, or
/// as many as its settings divide its angle by, which is unwrapped here: where the motor turns by more than a quarter of that from
/// one cycle to the next, it has no position any more.
///
/// Its watchdog is that of its app settings (timeout); what it takes is found out by proves_watchdog().
class VescDriver : public SerialDriver {
 public:
  /// Throws DriverFailed where the drive does not answer, is older, or stands on a fault; Error (invalid_argument) without a torque
  /// constant, before the port is opened.
  explicit VescDriver(const SerialLink& link);

  void arm() override;
  [[nodiscard]] std::optional<bool> proves_watchdog() override;

 protected:
  [[nodiscard]] std::size_t frame_size(std::string_view bytes) const noexcept override {
    return vesc_packet_size(bytes, is_reading_settings_ ? vesc_long_payload : vesc_short_payload);
  }
  [[nodiscard]] Heard hear(std::string_view frame) noexcept override;
  [[nodiscard]] SerialFrame question() noexcept override { return vesc_question(); }
  [[nodiscard]] SerialFrame mark() const noexcept override { return vesc_mark(); }
  [[nodiscard]] SerialFrame torque_frame(double torque) const noexcept override;
  [[nodiscard]] DriveProblem problem_of(Trouble trouble, long code) const override;
  void send_idle() noexcept override;

 private:
  VescDriver(const SerialLink& link, double torque_constant);
  [[nodiscard]] VescValues values();
  void read_firmware();
  void read_settings();

  double torque_constant_;
  double turns_modulo_ = 1.0;
  bool is_reading_settings_ = false;
  std::optional<double> last_turns_;
  bool has_lost_count_ = false;
};

}  // namespace zwidth::rig
