#include "stability/roots/interval_polynomial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace zwidth::internal {
namespace {

template <typename Function>
InterpolationValues values_of(const Function& function) {
  InterpolationValues values{};
  for (std::size_t i = 0; i < interpolation_points; ++i) values[i] = function(interpolation_nodes()[i]);
  return values;
}

TEST(IntervalPolynomial, AllValuesLieBetweenTheLeastAndGreatestCoefficient) {
  const auto function = [](double x) { return std::cos(3.0 * x) + 0.3 * x; };
  const InterpolationValues coefficients = bernstein_coefficients(values_of(function));
  const auto [least, greatest] = std::minmax_element(coefficients.begin(), coefficients.end());
  EXPECT_NEAR(coefficients.front(), function(-1.0), 1e-6);
  EXPECT_NEAR(coefficients.back(), function(1.0), 1e-6);
  const Halves halves = halves_of(coefficients);
  EXPECT_DOUBLE_EQ(halves.left.back(), halves.right.front());
  EXPECT_NEAR(halves.right.front(), function(0.0), 1e-6);
  for (double x = -1.0; x <= 1.0; x += 0.01) {
    EXPECT_GE(function(x), *least - 1e-6);
    EXPECT_LE(function(x), *greatest + 1e-6);
  }
}

// A pole of 1/(1 + (x/d)²) at +-j d: the error stated covers the error made while the ellipse through it is wide.
TEST(IntervalPolynomial, TheErrorStatedCoversTheErrorMade) {
  for (const double depth : {0.8, 1.0, 1.5, 3.0}) {
    ASSERT_GE(ellipse_through(-1.0, 1.0, 0.0, depth), 2.0);
    const auto function = [&](double x) { return 1.0 / (1.0 + x * x / (depth * depth)); };
    const InterpolationValues values = values_of(function);
    double error = 0.0;
    for (double x = -1.0; x <= 1.0; x += 0.003) {
      error = std::max(error, std::abs(InterpolatedAt(x)(values) - function(x)));
    }
    EXPECT_LE(error, interpolation_error(values) + 1e-14) << depth;
    EXPECT_GE(error, 1e-3 * interpolation_error(values)) << depth;
  }
}

TEST(IntervalPolynomial, EllipseThroughAPoint) {
  EXPECT_NEAR(ellipse_through(-1.0, 1.0, 0.0, 0.75), 2.0, 1e-14);
  EXPECT_NEAR(ellipse_through(2.0, 4.0, 4.25, 0.0), 2.0, 1e-14);
}

}  // namespace
}  // namespace zwidth::internal
