#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "identification/model/number.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// The devices that a fit looks among: a structure, and the numbers of it that are free.
///
/// The delay and the lag of an actuator act alike at low frequency: where the lag is a number, the number "loop.delay" is the sum
/// of both, which is what a record tells.
class DeviceFamily {
 public:
  /// `numbers`: those with a key of the device come first. `locked`: bodies held still while the record was made.
  DeviceFamily(DeviceParameters structure, std::vector<Number> numbers, std::vector<std::string> locked);

  [[nodiscard]] const std::vector<Number>& numbers() const noexcept { return numbers_; }
  /// How many are the device's.
  [[nodiscard]] Eigen::Index of_device() const noexcept { return of_device_; }
  /// As a device file has it, nothing locked: no delay below 0.
  [[nodiscard]] DeviceParameters device_at(const Eigen::VectorXd& x) const;
  /// As it was recorded: bodies locked, the delay left out (played_delay()).
  [[nodiscard]] Device recorded_device(const Eigen::VectorXd& x) const;
  /// s; below 0 where a lag is longer than the sum of both.
  [[nodiscard]] double played_delay(const Eigen::VectorXd& x) const;
  /// Where in x the value of a number of the device is.
  [[nodiscard]] Eigen::VectorXd coordinates_of(const DeviceParameters& device) const;

 private:
  [[nodiscard]] DeviceParameters values_at(const Eigen::VectorXd& x) const;

  DeviceParameters structure_;
  std::vector<Number> numbers_;
  std::vector<std::string> locked_;
  Eigen::Index of_device_ = 0;
  bool has_lag_ = false;
};

}  // namespace zwidth::internal
