#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "rig/odrive_can_protocol.hpp"
#include "rig/serial_driver.hpp"

namespace zwidth::rig {

/// An ODrive of firmware 0.5 or 0.6 on a CAN bus, CANSimple: a question for the encoder's estimates, a torque.
///
/// What its axis does is told by its heartbeat alone: whoever stands on an error or has let go has no position from then on.
/// A position that comes unasked would pass for an answer, and be older than it seems: a drive that sends it cyclically is
/// refused, with the setting that ends it. CANSimple sets no watchdog; what the drive's own takes is found by proves_watchdog().
class OdriveCanDriver : public SerialDriver {
 public:
  /// Throws DriverFailed where the drive is not heard, sends its position unasked, or stands on an error.
  explicit OdriveCanDriver(const SerialLink& link);

  void arm() override;
  [[nodiscard]] std::optional<bool> proves_watchdog() override;

 protected:
  [[nodiscard]] Heard hear(std::string_view frame) noexcept override;
  [[nodiscard]] SerialFrame question() noexcept override;
  [[nodiscard]] SerialFrame mark() const noexcept override;
  [[nodiscard]] SerialFrame torque_frame(double torque) const noexcept override;
  [[nodiscard]] DriveProblem problem_of(Trouble trouble, long code) const override;
  void send_idle() noexcept override;

 private:
  /// Reads for so long: the first heartbeat, unless `until_end`, and whether there is anything that would pass for an answer.
  struct Listened {
    std::optional<OdriveHeartbeat> heartbeat;
    bool has_unasked = false;
  };
  [[nodiscard]] Listened listen(std::int64_t patience, bool until_end);
  [[nodiscard]] bool is_version_6();
  void request_closed_loop();

  int node_;
  bool is_6_ = false;  // firmware 0.6, which has other errors
  bool is_armed_ = false;
  std::optional<OdriveHeartbeat> trouble_;  // since it was armed
  std::int64_t heard_ = 0;                  // ns, when the heartbeat was
};

}  // namespace zwidth::rig
