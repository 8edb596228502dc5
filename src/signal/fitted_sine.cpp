#include "signal/fitted_sine.hpp"

#include <cmath>
#include <cstddef>

#include "linear_systems.hpp"

namespace zwidth::internal {
namespace {

/// Of a sample, from the end of the signal.
double place(std::size_t index, std::size_t size) { return static_cast<double>(index) - static_cast<double>(size - 1); }

}  // namespace

FittedSine fit_sine(std::span<const double> signal, double angle) {
  constexpr Eigen::Index unknowns = 4;
  const auto rows = static_cast<Eigen::Index>(signal.size());
  if (rows < unknowns) return {angle, 0.0, 0.0, 0.0};
  Eigen::MatrixXd shapes(rows, unknowns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double k = place(static_cast<std::size_t>(i), signal.size());
    shapes.row(i) << 1.0, k / static_cast<double>(rows), std::cos(angle * k), std::sin(angle * k);
  }
  const Eigen::Vector4d weights = least_squares(shapes, Eigen::Map<const Eigen::VectorXd>(signal.data(), rows));
  return {angle, weights[2], weights[3], std::hypot(weights[2], weights[3])};
}

std::vector<double> without(const FittedSine& sine, std::span<const double> signal) {
  std::vector<double> rest(signal.begin(), signal.end());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const double k = place(i, rest.size());
    rest[i] -= sine.cosine * std::cos(sine.angle * k) + sine.sine * std::sin(sine.angle * k);
  }
  return rest;
}

}  // namespace zwidth::internal
