#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// Standard normal numbers by Box and Muller's transform: the same with every standard library, which
// std::normal_distribution is not.
class NormalDraws {
 public:
  explicit NormalDraws(std::uint64_t seed) : random_(seed) {}

  [[nodiscard]] double next();

 private:
  [[nodiscard]] double uniform();

  std::mt19937_64 random_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

// Devices drawn from the uncertainty of one: impossible values, such as a negative damping, are brought to the
// nearest possible ones, near as the covariance measures it. They carry no uncertainty themselves.
class DeviceDraws {
 public:
  // The device must have uncertain parameters, and outlive the draws.
  DeviceDraws(const Device& device, std::uint64_t seed);

  [[nodiscard]] Device next();

 private:
  const Device& device_;
  Eigen::MatrixXd covariance_;
  Eigen::MatrixXd root_;
  Eigen::VectorXd bounds_;  // of the shifts from the device's own values
  NormalDraws normal_;
};

}  // namespace zwidth::internal
