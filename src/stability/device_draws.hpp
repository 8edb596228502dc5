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

// The shifts' nearest within their lower bounds, as the covariance C measures distance: where one number goes to its bound
// the others follow by regression, so that what is known of them together stays so.
//
//     d + C_i (b_i - d_i) / C_ii        and of the others C - C_i C_i' / C_ii, until none is beyond its bound
void bring_within(Eigen::VectorXd& shifts, const Eigen::VectorXd& bounds, const Eigen::MatrixXd& covariance);

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
