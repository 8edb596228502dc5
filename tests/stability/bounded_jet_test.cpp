#include "stability/loop/bounded_jet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "sampling/unit_circle.hpp"
#include "stability/loop/plant_fraction.hpp"

namespace zwidth {
using namespace internal;
namespace {

using Jet = BoundedJet<double>;

// A function of x with its Taylor model on [begin, end].
struct Modelled {
  std::function<double(double)> function;
  Jet jet;
};

// x itself, in u = (x - centre)/half in [-1, 1].
Modelled variable(double begin, double end) {
  return {[](double x) { return x; },
          Jet(0.5 * (begin + end), 0.5 * (end - begin), 0.0, std::max(std::abs(begin), std::abs(end)))};
}

Modelled random_expression(std::mt19937_64& random, double begin, double end, int depth) {
  std::uniform_real_distribution<double> constant(-2.0, 2.0);
  if (depth == 0) return variable(begin, end);
  const Modelled a = random_expression(random, begin, end, depth - 1);
  const Modelled b = random_expression(random, begin, end, depth - 1);
  const double c = constant(random);
  switch (random() % 7) {
    case 0:
      return {[=](double x) { return a.function(x) + b.function(x); }, a.jet + b.jet};
    case 1:
      return {[=](double x) { return a.function(x) - b.function(x); }, a.jet - b.jet};
    case 2:
      return {[=](double x) { return a.function(x) * b.function(x); }, a.jet * b.jet};
    case 3:
      return {[=](double x) { return a.function(x) * a.function(x); }, square(a.jet)};
    case 4:
      return {[=](double x) { return c * a.function(x) + c; }, c * a.jet + c};
    case 5:
      return {[=](double x) { return c - a.function(x); }, c - a.jet};
    default:
      return {[=](double x) { return -a.function(x) * b.function(x); }, -a.jet * b.jet};
  }
}

// |f(u) - value - slope u| <= bend/2, |f| <= size, |f| <= weight, on a fine grid.
void expect_enclosed(const Modelled& f, double begin, double end) {
  const double centre = 0.5 * (begin + end);
  const double half = 0.5 * (end - begin);
  const double rounding = 1e-13 * (f.jet.weight + f.jet.size());
  for (int i = 0; i <= 200; ++i) {
    const double u = -1.0 + 0.01 * i;
    const double exact = f.function(centre + half * u);
    EXPECT_LE(std::abs(exact - f.jet.value - f.jet.slope * u), 0.5 * f.jet.bend + rounding);
    EXPECT_LE(std::abs(exact), f.jet.size() + rounding);
    EXPECT_LE(std::abs(exact), f.jet.weight + rounding);
  }
  const double step = 1e-5;
  for (int i = -9; i <= 9; ++i) {  // slope in u by differences
    const double u = 0.1 * i;
    const double slope =
        (f.function(centre + half * (u + step)) - f.function(centre + half * (u - step))) / (2.0 * step);
    EXPECT_LE(std::abs(slope), f.jet.slope_size() + 1e-5 * (f.jet.weight + f.jet.slope_size()));
  }
}

TEST(BoundedJet, EnclosesRandomExpressions) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-1.5, 1.5);
    const double begin = place(random);
    const double width = std::pow(10.0, -static_cast<double>(seed % 4));
    SCOPED_TRACE(seed);
    const int depth = 1 + static_cast<int>(seed % 4);
    expect_enclosed(random_expression(random, begin, begin + width, depth), begin, begin + width);
    if (HasFailure()) return;
  }
}

// The bound is of second order: on a tenth of the interval it is a hundredth.
TEST(BoundedJet, BendShrinksWithTheSquareOfTheInterval) {
  std::mt19937_64 random(5);
  std::mt19937_64 same(5);
  const double wide = random_expression(random, 0.5, 0.7, 3).jet.bend;
  const double narrow = random_expression(same, 0.59, 0.61, 3).jet.bend;
  EXPECT_GT(wide, 0.0);
  EXPECT_LT(narrow, 0.02 * wide);
}

// sin² = x (1 - x/4) and polynomials in z - 1, on intervals of x = |z - 1|².
TEST(BoundedJet, EnclosesPolynomialsOnTheCircle) {
  const double coefficients[] = {0.3, -1.2, 0.7, 0.2, -0.4, 1.1};
  for (const auto& [begin, end] : std::vector<std::pair<double, double>>{
           {0.0, 4.0}, {0.0, 1e-6}, {1e-8, 1e-7}, {0.5, 0.9}, {3.9, 4.0}, {1.0, 3.0}}) {
    const CirclePoint<Jet> interval = circle_interval<double>(begin, end);
    expect_enclosed({[](double x) { return x * (1.0 - 0.25 * x); }, interval.sine_squared}, begin, end);
    for (std::size_t count = 1; count <= 6; ++count) {
      const OnCircle<Jet> jet = polynomial(coefficients, count, 0.9, interval);
      const auto at = [&](double x) {
        return polynomial(coefficients, count, 0.9, CirclePoint<double>{x, x * (1.0 - 0.25 * x)});
      };
      expect_enclosed({[&](double x) { return at(x).even; }, jet.even}, begin, end);
      expect_enclosed({[&](double x) { return at(x).odd; }, jet.odd}, begin, end);
      expect_enclosed({[&](double x) {
                         return squared_magnitude(at(x), CirclePoint<double>{x, x * (1.0 - 0.25 * x)});
                       },
                       squared_magnitude(jet, interval)},
                      begin, end);
    }
  }
}

// even + j sin odd is the polynomial itself.
TEST(UnitCircle, SplitsIntoEvenAndOdd) {
  const double coefficients[] = {0.3, -1.2, 0.7, 0.2, -0.4, 1.1};
  for (std::size_t count = 1; count <= 6; ++count) {
    for (const double angle : {1e-6, 0.01, 1.0, 2.0, 3.0, 3.14}) {
      const std::complex<double> delta = std::polar(1.0, angle) - 1.0;
      std::complex<double> exact = 0.9;
      for (std::size_t i = count; i-- > 0;) exact = exact * delta + coefficients[i];
      const OnCircle<double> split = polynomial(coefficients, count, 0.9, circle_point(angle));
      EXPECT_NEAR(split.even, exact.real(), 1e-14);
      EXPECT_NEAR(split.odd * std::sin(angle), exact.imag(), 1e-14);
    }
  }
}

}  // namespace
}  // namespace zwidth
