#include "stability/device_draws.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "eigenvalues.hpp"
#include "model/key_members.hpp"
#include "model/rate_ratio.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

// What a number of a device may be where it is not 0 (device.hpp).
constexpr double smallest_value = 1e-30;
constexpr double largest_value = 1e30;

// Of a mass, and of what is another structure at 0 (a link's stiffness): less of it hardly shows.
constexpr double least_share = 0.01;
// Of a variance: what is left of it is rounding.
constexpr double rounding = 1e-9;

Eigen::MatrixXd matrix_of(const std::vector<std::vector<double>>& covariance) {
  const auto n = static_cast<Eigen::Index>(covariance.size());
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      matrix(i, j) = covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  return matrix;
}

/// A with A A^T = covariance, semidefinite ones included; scaled so that units do not matter.
Eigen::MatrixXd square_root(Eigen::MatrixXd matrix) {
  const Eigen::Index n = matrix.rows();
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

/// The damper's period stays the part or multiple of the spring's that it is.
void keep_ratio(const Loop& of_device, Loop& drawn) {
  const double ratio = rate_ratio(of_device.sampling_period, damper_timing(of_device).sampling_period);
  if (drawn.damper->sampling_period) drawn.damper->sampling_period = drawn.sampling_period / ratio;
}

}  // namespace

void bring_within(Eigen::VectorXd& shifts, const Eigen::VectorXd& bounds, const Eigen::MatrixXd& covariance) {
  if ((shifts.array() >= bounds.array()).all()) return;
  Eigen::MatrixXd left = covariance;
  for (Eigen::Index round = 0; round < shifts.size(); ++round) {
    Eigen::Index farthest = -1;
    double most = 0.0;
    for (Eigen::Index i = 0; i < shifts.size(); ++i) {
      if (left(i, i) <= rounding * covariance(i, i)) continue;  // at its bound, or follows from those
      const double beyond = (bounds(i) - shifts(i)) / std::sqrt(left(i, i));
      if (beyond > most) farthest = i;
      most = std::max(most, beyond);
    }
    if (farthest < 0) break;
    const Eigen::VectorXd column = left.col(farthest) / left(farthest, farthest);
    shifts += column * (bounds(farthest) - shifts(farthest));
    left -= column * left.row(farthest);
    left.row(farthest).setZero();
    left.col(farthest).setZero();
  }
}

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
    : device_(device),
      covariance_(matrix_of(device.parameters().uncertainty->covariance)),
      root_(square_root(covariance_)),
      bounds_(covariance_.rows()),
      normal_(seed) {
  const std::vector<std::string>& keys = device.parameters().uncertainty->parameters;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const double mean = *parameter(device.parameters(), keys[i]);
    const std::string key = full_parameter_key(device.parameters(), keys[i]);
    bounds_(static_cast<Eigen::Index>(i)) = may_vanish(*row_of(key)) ? -mean : (least_share - 1.0) * mean;
  }
}

Device DeviceDraws::next() {
  const std::vector<std::string>& keys = device_.parameters().uncertainty->parameters;
  Eigen::VectorXd standard(root_.cols());
  for (double& value : standard) value = normal_.next();
  Eigen::VectorXd shifts = root_ * standard;
  bring_within(shifts, bounds_, covariance_);
  DeviceParameters drawn = device_.parameters();
  drawn.uncertainty.reset();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const double mean = *parameter(drawn, keys[i]);
    const auto k = static_cast<Eigen::Index>(i);
    if (shifts(k) == 0.0) continue;
    set_parameter(drawn, keys[i], std::clamp(mean + std::max(shifts(k), bounds_(k)), smallest_value, largest_value));
  }
  if (drawn.loop.damper) keep_ratio(device_.loop(), drawn.loop);
  drawn.loop.delay = std::min(drawn.loop.delay, max_delay_samples * drawn.loop.sampling_period);
  return Device(std::move(drawn));
}

}  // namespace zwidth::internal
