#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rig/serial_driver.hpp"

namespace zwidth::rig {

/// An ODrive of firmware 0.5.1 to 0.6 over its ASCII protocol, with checksums: `f` for the position, `c` for the torque.
///
/// Its watchdog, which `c` feeds and `f` does not, is set to 100 ms, or four periods, and enabled by arm(); what it was before, and
/// the mode of the controller, are put back in the end. That the axis has failed and applies no torque `f` does not tell either: every eighth cycle its error is asked for too.
/// A damper is its velocity loop's gain: then `v` at velocity 0 brings the torque.
class OdriveDriver : public SerialDriver {
 public:
  /// Throws DriverFailed where the drive does not answer, or stands on an error.
  explicit OdriveDriver(const SerialLink& link);
  ~OdriveDriver() override;
  OdriveDriver(const OdriveDriver&) = delete;
  OdriveDriver& operator=(const OdriveDriver&) = delete;

  void close_damper(const Device& device, std::optional<double> force_limit) override;
  void arm() override;
  [[nodiscard]] std::optional<bool> proves_watchdog() override;

 protected:
  [[nodiscard]] std::size_t frame_size(std::string_view bytes) const noexcept override;
  [[nodiscard]] Heard hear(std::string_view frame) noexcept override;
  [[nodiscard]] SerialFrame question() noexcept override;
  [[nodiscard]] SerialFrame mark() const noexcept override;
  [[nodiscard]] SerialFrame torque_frame(double torque) const noexcept override;
  [[nodiscard]] DriveProblem problem_of(Trouble trouble, long code) const override;
  void send_idle() noexcept override;

 private:
  [[nodiscard]] std::string property(std::string_view name);
  void set_property(std::string_view name, std::string_view value);
  /// What the axis answers to that property, a number or not.
  [[nodiscard]] std::string said_of(std::string_view name);
  /// The first answer tells how the firmware ends its lines and what it calls its errors.
  void read_firmware();
  [[nodiscard]] std::optional<double> first_number_of(std::initializer_list<std::string_view> names);
  void read_limits();
  void keep_settings();
  void tell_damper();
  void request_closed_loop();
  [[nodiscard]] long error();

  int axis_;
  double watchdog_;  // s
  bool ends_lines_ = true;
  std::string_view error_name_ = "error";
  std::string_view torque_limit_name_ = "motor.config.torque_lim";
  long watchdog_expired_ = 1L << 11;
  std::vector<std::pair<std::string_view, std::string>> settings_;  // before arm()
  unsigned asked_ = 0;
  long error_ = 0;
};

}  // namespace zwidth::rig
