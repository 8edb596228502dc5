#include "stability/device_draws.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "eigenvalues.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

// What a number of a device may be where it is not 0 (device.hpp).
constexpr double smallest_value = 1e-30;
constexpr double largest_value = 1e30;

/// A with A A^T = covariance, semidefinite ones included; scaled so that units do not matter.
Eigen::MatrixXd square_root(const std::vector<std::vector<double>>& covariance) {
  const auto n = static_cast<Eigen::Index>(covariance.size());
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      matrix(i, j) = covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  const Eigen::VectorXd deviation = matrix.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double scale = deviation(i) * deviation(j);
      matrix(i, j) = scale > 0.0 ? matrix(i, j) / scale : 0.0;
    }
  }
  const SymmetricEigen eigen = symmetric_eigen(matrix);
  return deviation.asDiagonal() * eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace

double NormalDraws::next() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

/// In (0, 1], from the upper 53 bits.
double NormalDraws::uniform() { return static_cast<double>((random_() >> 11U) + 1) * 0x1p-53; }

DeviceDraws::DeviceDraws(const Device& device, std::uint64_t seed)
    : device_(device), root_(square_root(device.parameters().uncertainty->covariance)), normal_(seed) {}

Device DeviceDraws::next() {
  const std::vector<std::string>& keys = device_.parameters().uncertainty->parameters;
  Eigen::VectorXd standard(root_.cols());
  for (double& value : standard) value = normal_.next();
  const Eigen::VectorXd deviation = root_ * standard;
  DeviceParameters drawn = device_.parameters();
  drawn.uncertainty.reset();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const double mean = *parameter(drawn, keys[i]);
    const double shift = deviation(static_cast<Eigen::Index>(i));
    if (shift != 0.0) set_parameter(drawn, keys[i], std::clamp(std::abs(mean + shift), smallest_value, largest_value));
  }
  drawn.loop.delay = std::min(drawn.loop.delay, max_delay_samples * drawn.loop.sampling_period);
  return Device(std::move(drawn));
}

}  // namespace zwidth::internal
