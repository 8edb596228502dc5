#pragma once

#include <optional>
#include <string>

#include "rig/moteus_protocol.hpp"
#include "rig/serial_driver.hpp"
#include "zwidth/rig/can_frame_time.hpp"

namespace zwidth::rig {

/// A moteus controller over the lines of fdcanusb: on its own UART, with checksums, or behind an fdcanusb, which has none
/// of its own (USB and CAN-FD do); or on a CAN-FD bus behind any adapter, as if an fdcanusb were there.
///
/// Torque in position mode without gains, or with that of velocity alone, which is its damper. The watchdog of each command, 100 ms, ends in a mode of which only a stop leads
/// out: mode and position are read together, and a position in any other mode than that of torque is none, until it is disarmed.
class MoteusDriver : public SerialDriver {
 public:
  /// Throws DriverFailed where the drive does not answer, stands on a fault, or would hold its position once its watchdog has let go.
  explicit MoteusDriver(const SerialLink& link);

  void close_damper(const Device& device, std::optional<double> force_limit) override;
  void arm() override;
  [[nodiscard]] std::optional<bool> proves_watchdog() override;

 protected:
  [[nodiscard]] Heard hear(std::string_view frame) noexcept override;
  [[nodiscard]] SerialFrame question() noexcept override;
  [[nodiscard]] SerialFrame mark() const noexcept override;
  [[nodiscard]] SerialFrame torque_frame(double torque) const noexcept override;
  [[nodiscard]] DriveProblem problem_of(Trouble trouble, long code) const override;
  [[nodiscard]] DriveProblem unanswered() const override;
  void send_idle() noexcept override;

 private:
  [[nodiscard]] SerialFrame line(const SerialFrame& text) const noexcept {
    return moteus_line(text.view(), has_checksums_);
  }
  [[nodiscard]] int mode();
  [[nodiscard]] std::string said_to(const std::string& text);
  /// The number that it has under that name; nothing where it does not know the name.
  [[nodiscard]] std::optional<double> configured(std::string_view name);
  void read_firmware();
  void read_position_filter(unsigned version);
  void tell_damper();

  int id_;
  std::optional<CanBitRates> can_rates_;  // absent: a serial line
  bool has_checksums_;
};

}  // namespace zwidth::rig
