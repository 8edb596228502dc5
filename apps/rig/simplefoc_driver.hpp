#pragma once

#include <string>
#include <string_view>

#include "rig/serial_driver.hpp"

namespace zwidth::rig {

/// A motor of SimpleFOC (2.3 and 2.4) behind its Commander: `MMG6` for the angle, `M` for a target of torque.
///
/// The unit of a target is the sketch's: amperes, or volts of the motor. A damper is the velocity loop's P alone: a target
/// is the velocity then, P times which is the torque. There is no checksum, and no watchdog but one of the sketch, which disables
/// the motor when no command comes: where there is none and this program dies, the torque stays.
class SimplefocDriver : public SerialDriver {
 public:
  /// Throws DriverFailed where the drive does not answer, or controls its torque in a way that is not known; Error
  /// (invalid_argument) without the constant for its unit.
  explicit SimplefocDriver(const SerialLink& link);

  void close_damper(const Device& device, std::optional<double> force_limit) override;
  void arm() override;
  /// By silences of 0.1, 0.2 and 0.5 s: the first after which the motor is disabled counts as its time.
  [[nodiscard]] std::optional<bool> proves_watchdog() override;

 protected:
  [[nodiscard]] Heard hear(std::string_view frame) noexcept override;
  [[nodiscard]] SerialFrame question() noexcept override;
  [[nodiscard]] SerialFrame mark() const noexcept override;
  [[nodiscard]] SerialFrame torque_frame(double torque) const noexcept override;
  [[nodiscard]] DriveProblem problem_of(Trouble trouble, long code) const override;
  void send_idle() noexcept override;

 private:
  [[nodiscard]] Subject motor_name() const;
  /// What the motor answers to that command: "volt" to "T".
  [[nodiscard]] std::string setting(std::string_view command, std::string_view echo);
  [[nodiscard]] double torque_per_target();
  void tell_damper();

  std::string motor_;
  bool is_by_volts_ = false;
  double torque_per_target_;  // N m/A or N m/V
};

}  // namespace zwidth::rig
