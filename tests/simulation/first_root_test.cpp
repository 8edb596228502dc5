#include "simulation/first_root.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <cmath>
#include <random>
#include <vector>

namespace zwidth {
using namespace internal;
namespace {

using Real = boost::multiprecision::cpp_dec_float_50;

Real value_at(const std::vector<double>& coefficients, const Real& s) {
  Real value = 0;
  for (std::size_t k = coefficients.size(); k-- > 0;) value = value * s + coefficients[k];
  return value;
}

std::vector<double> derivative(const std::vector<double>& coefficients) {
  std::vector<double> result;
  for (std::size_t k = 1; k < coefficients.size(); ++k) result.push_back(static_cast<double>(k) * coefficients[k]);
  return result;
}

/// All sign changes in [0, 1], by the roots of the derivative: between two of them a polynomial is monotonic.
std::vector<Real> sign_changes(const std::vector<double>& coefficients) {
  if (coefficients.size() < 2) return {};
  std::vector<Real> bounds = sign_changes(derivative(coefficients));
  bounds.insert(bounds.begin(), Real(0));
  bounds.push_back(Real(1));
  std::vector<Real> changes;
  for (std::size_t i = 1; i < bounds.size(); ++i) {
    Real low = bounds[i - 1];
    Real high = bounds[i];
    const bool falls = value_at(coefficients, low) >= 0;
    if ((value_at(coefficients, high) >= 0) == falls) continue;
    for (int halving = 0; halving < 160; ++halving) {
      const Real middle = (low + high) / 2;
      ((value_at(coefficients, middle) >= 0) == falls ? low : high) = middle;
    }
    changes.push_back(high);
  }
  return changes;
}

double exact_first_turn_negative(const std::vector<double>& coefficients) {
  if (coefficients[0] < 0.0) return 0.0;
  const auto changes = sign_changes(coefficients);
  return changes.empty() ? 2.0 : static_cast<double>(changes.front());
}

TEST(FirstTurnNegative, EqualsFiftyDigitsOnRandomPolynomials) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::size_t found = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<double> coefficients(2 + random() % 11);
    for (double& each : coefficients) each = normal(random) * std::exp(normal(random));
    coefficients[0] = std::abs(coefficients[0]);
    const double exact = exact_first_turn_negative(coefficients);
    const double ours = first_turn_negative(coefficients);
    ASSERT_EQ(ours <= 1.0, exact <= 1.0) << trial;
    if (exact > 1.0) continue;
    ++found;
    // As far as the coefficients' rounding lets a root be known: error of the value over the slope.
    double sum = 0.0;
    for (const double each : coefficients) sum += std::abs(each);
    const double slope = std::abs(static_cast<double>(value_at(derivative(coefficients), Real(exact))));
    ASSERT_NEAR(ours, exact, 1e-15 + 4.0 * 2.2e-16 * sum / slope) << trial;
  }
  EXPECT_GT(found, 100U);
}

TEST(FirstTurnNegative, FindsEveryRootOfClosePairsBeforeLaterOnes) {
  // (s - a)² - d² turns negative at a - d, and positive again at a + d.
  for (const double a : {0.1, 0.37, 0.5, 0.93}) {
    for (const double d : {1e-2, 1e-4, 1e-6}) {
      const std::vector<double> pair = {a * a - d * d, -2.0 * a, 1.0};
      EXPECT_NEAR(first_turn_negative(pair), a - d, 1e-9) << a << " " << d;
    }
    // Lifted by 1e-9 it stays positive.
    EXPECT_GT(first_turn_negative(std::vector<double>{a * a + 1e-9, -2.0 * a, 1.0}), 1.0) << a;
  }
}

TEST(FirstTurnNegative, Edges) {
  EXPECT_GT(first_turn_negative({}), 1.0);
  EXPECT_GT(first_turn_negative(std::vector<double>{0.0}), 1.0);
  EXPECT_GT(first_turn_negative(std::vector<double>{1.0}), 1.0);
  EXPECT_EQ(first_turn_negative(std::vector<double>{-1.0}), 0.0);
  EXPECT_EQ(first_turn_negative(std::vector<double>{-1e-300, 1.0}), 0.0);
  EXPECT_GT(first_turn_negative(std::vector<double>{0.0, 1.0}), 1.0);
  EXPECT_NEAR(first_turn_negative(std::vector<double>{0.0, -1.0}), 0.0, 1e-15);
  EXPECT_NEAR(first_turn_negative(std::vector<double>{0.0, 1.0, -2.0}), 0.5, 1e-15);
  EXPECT_NEAR(first_turn_negative(std::vector<double>{1.0, 0.0, 0.0, -8.0}), 0.5, 1e-15);
  EXPECT_GT(first_turn_negative(std::vector<double>{1.0, -1.0}), 0.999);  // only just reaches 0 at the end
  EXPECT_GT(first_turn_negative(std::vector<double>{0.0, 0.0, 0.0}), 1.0);
}

}  // namespace
}  // namespace zwidth
