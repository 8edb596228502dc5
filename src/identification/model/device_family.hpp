#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "identification/model/number.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// Keys of numbers by which a device changes while it is recorded; they move nothing but what device_at() says of instants.
inline constexpr const char* key_of_damping_drift = "damping_drift";  ///< share of all free dampings to the ground
inline constexpr const char* key_of_delay_drift = "delay_drift";      ///< s

/// When during a record each drift of a device is asked: 0 its beginning, 1 its end.
struct DriftInstants {
  double damping = 0.5;
  double delay = 0.5;
};

/// The devices that a fit looks among: a structure, and the numbers of it that are free.
///
/// The delay and the lag of an actuator act alike at low frequency: where the lag is a number, the number "loop.delay" is the sum
/// of both, which is what a record tells.
class DeviceFamily {
 public:
  /// `numbers`: those of the device come first. `locked`: bodies held still while the record was made.
  DeviceFamily(DeviceParameters structure, std::vector<Number> numbers, std::vector<std::string> locked);

  [[nodiscard]] const std::vector<Number>& numbers() const noexcept { return numbers_; }
  /// How many are the device's.
  [[nodiscard]] Eigen::Index of_device() const noexcept { return of_device_; }
  /// How many of the first numbers device_at() hangs on, at any instants: the device's and its drifts. The limit hangs on no other.
  [[nodiscard]] Eigen::Index of_limit() const noexcept { return of_limit_; }
  /// As a device file has it, nothing locked: no delay below 0.
  [[nodiscard]] DeviceParameters device_at(const Eigen::VectorXd& x) const;
  /// As it is during a record, its drifts at instants of it:
  ///
  ///     b_i <- b_i max(0, 1 + damping_drift (instants.damping - 1/2)),  delay <- max(0, delay + delay_drift instants.delay)
  [[nodiscard]] DeviceParameters device_at(const Eigen::VectorXd& x, const DriftInstants& instants) const;
  /// Whether the numbers make a device: recorded_device() throws where not.
  [[nodiscard]] bool has_device_at(const Eigen::VectorXd& x) const;
  /// As it was recorded: bodies locked, the delay left out (played_delay()).
  [[nodiscard]] Device recorded_device(const Eigen::VectorXd& x) const;
  /// s; below 0 where a lag is longer than the sum of both.
  [[nodiscard]] double played_delay(const Eigen::VectorXd& x) const;
  /// Where in x the value of a number of the device is; all others are where a fit starts.
  [[nodiscard]] Eigen::VectorXd coordinates_of(const DeviceParameters& device) const;

 private:
  [[nodiscard]] DeviceParameters values_at(const Eigen::VectorXd& x) const;
  /// Of values before the lag is taken from the delay.
  [[nodiscard]] DeviceParameters finished(DeviceParameters values) const;
  [[nodiscard]] double value_of(const std::string& key, const Eigen::VectorXd& x) const;

  DeviceParameters structure_;
  std::vector<Number> numbers_;
  std::vector<std::string> locked_;
  Eigen::Index of_device_ = 0;
  Eigen::Index of_limit_ = 0;
  bool has_damping_drift_ = false;
  bool has_delay_drift_ = false;
  bool has_lag_ = false;
};

}  // namespace zwidth::internal
