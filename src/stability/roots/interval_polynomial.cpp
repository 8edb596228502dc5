#include "stability/roots/interval_polynomial.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace zwidth::internal {
namespace {

constexpr int points = static_cast<int>(interpolation_points);
constexpr int degree = points - 1;
using Matrix = Eigen::Matrix<double, points, points>;
using Vector = Eigen::Matrix<double, points, 1>;

struct Tables {
  InterpolationValues nodes{};
  InterpolationValues weights{};
  Matrix to_bernstein;
  Matrix last_chebyshev;  // only its first two rows: the coefficients of degree - 1 and degree
};

Tables make_tables() {
  using Real = long double;
  Tables tables;
  Eigen::Matrix<Real, points, points> bernstein;
  tables.last_chebyshev.setZero();
  for (int i = 0; i < points; ++i) {
    const double angle = std::numbers::pi * (degree - i + 0.5) / points;
    const auto row = static_cast<std::size_t>(i);
    tables.nodes[row] = std::cos(angle);
    tables.weights[row] = (i % 2 == 0 ? 1.0 : -1.0) * std::sin(angle);
    const Real t = Real(0.5) * (Real(1.0) + Real(tables.nodes[row]));
    Real binomial = 1.0L;
    for (int j = 0; j < points; ++j) {
      bernstein(i, j) = binomial * std::pow(t, Real(j)) * std::pow(Real(1.0) - t, Real(degree - j));
      binomial *= Real(degree - j) / Real(j + 1);
    }
    for (int row_of = 0; row_of < 2; ++row_of) {
      tables.last_chebyshev(row_of, i) = 2.0 / points * std::cos((degree - 1 + row_of) * angle);
    }
  }
  const Eigen::Matrix<Real, points, points> inverse = bernstein.fullPivLu().inverse();
  tables.to_bernstein = inverse.cast<double>();
  return tables;
}

const Tables& tables() {
  static const Tables made = make_tables();
  return made;
}

}  // namespace

const InterpolationValues& interpolation_nodes() { return tables().nodes; }

InterpolationValues bernstein_coefficients(const InterpolationValues& values) {
  InterpolationValues coefficients{};
  Eigen::Map<Vector>(coefficients.data()).noalias() = tables().to_bernstein * Eigen::Map<const Vector>(values.data());
  return coefficients;
}

double interpolation_error(const InterpolationValues& values) {
  const Eigen::Map<const Vector> of(values.data());
  const double last =
      std::abs(tables().last_chebyshev.row(0).dot(of)) + std::abs(tables().last_chebyshev.row(1).dot(of));
  return 2.0 * last;
}

// With the weights (-1)^i sin(angle_i) of these nodes.
InterpolatedAt::InterpolatedAt(double x) {
  for (std::size_t i = 0; i < interpolation_points; ++i) weights_[i] = tables().weights[i] / (x - tables().nodes[i]);
  for (std::size_t i = 0; i < interpolation_points; ++i) {
    if (x == tables().nodes[i]) weights_.fill(0.0), weights_[i] = 1.0;
  }
  for (const double weight : weights_) sum_ += weight;
}

double InterpolatedAt::operator()(const InterpolationValues& values) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < interpolation_points; ++i) sum += weights_[i] * values[i];
  return sum / sum_;
}

Halves halves_of(const InterpolationValues& coefficients) {
  Halves halves;
  InterpolationValues row = coefficients;
  for (std::size_t level = 0; level < interpolation_points; ++level) {
    const std::size_t last = interpolation_points - 1 - level;
    halves.left[level] = row[0];
    halves.right[last] = row[last];
    for (std::size_t i = 0; i < last; ++i) row[i] = 0.5 * (row[i] + row[i + 1]);
  }
  return halves;
}

double ellipse_through(double begin, double end, double position, double depth) {
  const double half = 0.5 * (end - begin);
  const std::complex<double> z((position - 0.5 * (begin + end)) / half, depth / half);
  const std::complex<double> root = std::sqrt(z * z - 1.0);
  return std::max(std::abs(z + root), std::abs(z - root));
}

}  // namespace zwidth::internal
