#include "zwidth/stability/stiffness_interval.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "model/symmetric_eigen.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
namespace {

// What a number of a device may be where it is not 0 (device.hpp).
constexpr double smallest_value = 1e-30;
constexpr double largest_value = 1e30;

/// Standard normal numbers by Box and Muller's transform: the same with every standard library, which
/// std::normal_distribution is not.
class NormalDraws {
 public:
  explicit NormalDraws(std::uint64_t seed) : random_(seed) {}

  [[nodiscard]] double next() {
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

 private:
  /// In (0, 1], from the upper 53 bits.
  [[nodiscard]] double uniform() { return static_cast<double>((random_() >> 11U) + 1) * 0x1p-53; }

  std::mt19937_64 random_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

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
  const internal::SymmetricEigen eigen = internal::symmetric_eigen(matrix);
  return deviation.asDiagonal() * eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

CriticalStiffness critical_stiffness_of(const Device& device) {
  return critical_stiffness(filtered_plant(device), virtual_damper(device));
}

bool same_mechanism(const CriticalStiffness& a, const CriticalStiffness& b) {
  if (a.limit.has_value() != b.limit.has_value()) return false;
  if (!a.limit) return a.status == b.status;
  return a.limit->limited_by.kind == b.limit->limited_by.kind && a.limit->limited_by.mode == b.limit->limited_by.mode;
}

}  // namespace

StiffnessInterval stiffness_interval(const Device& device, std::size_t draws, std::uint64_t seed) {
  const std::optional<Uncertainty>& uncertainty = device.parameters().uncertainty;
  if (!uncertainty || uncertainty->parameters.empty())
    throw Error(ErrorCode::invalid_argument, "the device has no uncertainty");
  if (draws == 0) throw Error(ErrorCode::invalid_argument, "draws is 0; must be at least 1");
  const Eigen::MatrixXd root = square_root(uncertainty->covariance);
  const CriticalStiffness own = critical_stiffness_of(device);
  NormalDraws normal(seed);
  std::vector<double> stiffness;
  stiffness.reserve(draws);
  std::size_t others = 0;
  Eigen::VectorXd standard(root.cols());
  for (std::size_t draw = 0; draw < draws; ++draw) {
    for (double& value : standard) value = normal.next();
    const Eigen::VectorXd deviation = root * standard;
    DeviceParameters drawn = device.parameters();
    drawn.uncertainty.reset();
    for (std::size_t i = 0; i < uncertainty->parameters.size(); ++i) {
      const std::string& key = uncertainty->parameters[i];
      const double mean = *parameter(drawn, key);
      const double shift = deviation(static_cast<Eigen::Index>(i));
      if (shift != 0.0) set_parameter(drawn, key, std::clamp(std::abs(mean + shift), smallest_value, largest_value));
    }
    drawn.loop.delay = std::min(drawn.loop.delay, max_delay_samples * drawn.loop.sampling_period);
    const CriticalStiffness critical = critical_stiffness_of(Device(std::move(drawn)));
    stiffness.push_back(critical.stiffness);
    if (!same_mechanism(own, critical)) ++others;
  }
  std::ranges::sort(stiffness);
  const auto tail = static_cast<std::size_t>(0.025 * static_cast<double>(draws));
  // A parameter at its bound is drawn to one side of it only: the device itself is within, all the same.
  return {std::min(stiffness[tail], own.stiffness), std::max(stiffness[draws - 1 - tail], own.stiffness),
          static_cast<double>(others) / static_cast<double>(draws), draws};
}

}  // namespace zwidth
