#include "zwidth/sampling/filter_section.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr double period = 1e-3;

WallFilter filter(WallFilter::Kind kind, double frequency_hz) {
  WallFilter result;
  result.kind = kind;
  result.frequency_hz = frequency_hz;
  return result;
}

// F(s) as the docstring of WallFilter has it.
Complex continuous(const WallFilter& f, double frequency) {
  const Complex s = Complex(0.0, frequency) / (2.0 * pi * f.frequency_hz);
  switch (f.kind) {
    case WallFilter::Kind::low_pass:
      return f.order == 1 ? 1.0 / (s + 1.0) : 1.0 / (s * s + 2.0 * f.damping_ratio * s + 1.0);
    case WallFilter::Kind::notch:
      return (s * s + 2.0 * f.damping_ratio * f.depth * s + 1.0) / (s * s + 2.0 * f.damping_ratio * s + 1.0);
    case WallFilter::Kind::lead_lag:
      return (s * std::sqrt(f.ratio) + 1.0) / (s / std::sqrt(f.ratio) + 1.0);
    default:
      return 0.0;
  }
}

// Tustin's rule maps w to (2/T') tan(wT/2), with T' such that the filter's own frequency stays.
TEST(FilterSection, IsTheContinuousFilterAtTheWarpedFrequency) {
  for (const auto kind : {WallFilter::Kind::low_pass, WallFilter::Kind::notch, WallFilter::Kind::lead_lag}) {
    for (const int order : {1, 2}) {
      for (const double hz : {0.5, 60.0, 470.0}) {
        WallFilter f = filter(kind, hz);
        f.order = order;
        const FilterSection section = filter_section(f, period);
        const double own = 2.0 * pi * hz;
        for (const double angle : {1e-4, 0.1, own * period, 1.7, 3.1}) {
          const double warped = own * std::tan(angle / 2.0) / std::tan(own * period / 2.0);
          const Complex expected = continuous(f, warped);
          EXPECT_LT(std::abs(response(section, angle) - expected), 1e-13 * std::abs(expected))
              << hz << " Hz at " << angle;
        }
        EXPECT_NEAR(static_gain(section), 1.0, 1e-14);
      }
    }
  }
}

TEST(FilterSection, NotchHasItsDepthAtItsCentre) {
  WallFilter f = filter(WallFilter::Kind::notch, 80.0);
  f.depth = 0.01;
  EXPECT_NEAR(std::abs(response(filter_section(f, period), 2.0 * pi * 80.0 * period)), 0.01, 1e-13);
}

TEST(FilterSection, LeadHasItsPhaseAtItsFrequency) {
  WallFilter f = filter(WallFilter::Kind::lead_lag, 80.0);
  f.ratio = 9.0;
  EXPECT_NEAR(std::arg(response(filter_section(f, period), 2.0 * pi * 80.0 * period)), std::asin(0.8), 1e-13);
}

TEST(FilterSection, LowPassesByTustinVanishAtNyquist) {
  for (const int order : {1, 2}) {
    WallFilter f = filter(WallFilter::Kind::low_pass, 80.0);
    f.order = order;
    const FilterSection section = filter_section(f, period);
    EXPECT_EQ(section.nyquist_zeros, static_cast<std::size_t>(order));
    EXPECT_EQ(response(section, pi), 0.0);
  }
}

TEST(FilterSection, BiquadIsTheNotchWithItsCoefficients) {
  const double w = 2.0 * pi * 60.0;
  WallFilter b = filter(WallFilter::Kind::biquad, 60.0);
  b.numerator = {3.0, 3.0 * 0.2 * w, 3.0 * w * w};
  b.denominator = {3.0, 3.0 * 2.0 * w, 3.0 * w * w};
  WallFilter n = filter(WallFilter::Kind::notch, 60.0);
  n.damping_ratio = 1.0;
  n.depth = 0.1;
  for (const double angle : {0.01, 0.5, 2.0}) {
    EXPECT_LT(std::abs(response(filter_section(b, period), angle) - response(filter_section(n, period), angle)), 1e-13);
  }
  b.frequency_hz = 0.0;  // not prewarped: s = (2/T)(z - 1)/(z + 1)
  const Complex s(0.0, 2.0 / period * std::tan(0.25));
  const Complex expected = (s * s + 0.2 * w * s + w * w) / (s * s + 2.0 * w * s + w * w);
  EXPECT_LT(std::abs(response(filter_section(b, period), 0.5) - expected), 1e-13);
}

TEST(FilterSection, DigitalRunsAsItStands) {
  WallFilter f;
  f.kind = WallFilter::Kind::digital;
  f.numerator = {0.3, -0.1, 0.2};
  f.denominator = {2.0, -1.0, 0.5};
  for (const double angle : {0.0, 0.01, 1.0, pi}) {
    const Complex z = std::polar(1.0, angle);
    const Complex expected = (0.3 * z * z - 0.1 * z + 0.2) / (2.0 * z * z - z + 0.5);
    EXPECT_LT(std::abs(response(filter_section(f, period), angle) - expected), 1e-14) << angle;
  }
  f.numerator = {0.25, 0.5, 0.25};  // (z + 1)²/4
  EXPECT_EQ(filter_section(f, period).nyquist_zeros, 2u);
  EXPECT_EQ(response(filter_section(f, period), pi), 0.0);
  const Complex z = std::polar(1.0, 2.0);
  EXPECT_LT(std::abs(response(filter_section(f, period), 2.0) - 0.25 * (z + 1.0) * (z + 1.0) / (2.0 * z * z - z + 0.5)),
            1e-14);
}

TEST(FilterSection, WholeNumeratorHoldsTheZerosAtNyquist) {
  WallFilter f = filter(WallFilter::Kind::low_pass, 80.0);
  f.order = 2;
  const FilterSection section = filter_section(f, period);
  const auto n = whole_numerator(section);
  const Complex delta = std::polar(1.0, 1.3) - 1.0;
  const Complex value =
      (n[0] + delta * (n[1] + delta * n[2])) / (section.denominator[0] + delta * (section.denominator[1] + delta));
  EXPECT_LT(std::abs(value - response(section, 1.3)), 1e-15);
}

TEST(FilterSection, SlowFilterAtFastSamplingKeepsItsDigits) {
  WallFilter f = filter(WallFilter::Kind::notch, 1.0);
  const double fast = 1e-5;
  const FilterSection section = filter_section(f, fast);
  const double warped = 2.0 * pi * std::tan(2.0 * pi * 1.1 * fast / 2.0) / std::tan(2.0 * pi * fast / 2.0);
  EXPECT_LT(std::abs(response(section, 2.0 * pi * 1.1 * fast) - continuous(f, warped)), 1e-13);
}

TEST(WallFilter, WhatIsImpossibleIsNamed) {
  using enum WallFilter::Kind;
  const auto problem = [](auto change) {
    WallFilter f = filter(notch, 60.0);
    change(f);
    const auto found = find_problem(f, period);
    return found ? std::string(found->member) : std::string();
  };
  EXPECT_EQ(problem([](WallFilter&) {}), "");
  EXPECT_EQ(problem([](WallFilter& f) { f.frequency_hz = 500.0; }), "frequency_hz");
  EXPECT_EQ(problem([](WallFilter& f) { f.frequency_hz = 0.0; }), "frequency_hz");
  EXPECT_EQ(problem([](WallFilter& f) { f.frequency_hz = std::nan(""); }), "frequency_hz");
  EXPECT_EQ(problem([](WallFilter& f) { f.depth = 0.0; }), "depth");
  EXPECT_EQ(problem([](WallFilter& f) { f.depth = 2.0; }), "depth");
  EXPECT_EQ(problem([](WallFilter& f) { f.damping_ratio = -1.0; }), "damping_ratio");
  EXPECT_EQ(problem([](WallFilter& f) { f.kind = low_pass, f.order = 3; }), "order");
  EXPECT_EQ(problem([](WallFilter& f) { f.kind = lead_lag, f.ratio = 0.0; }), "ratio");
  const auto with = [&](WallFilter::Kind kind, std::vector<double> numerator, std::vector<double> denominator) {
    return problem([&](WallFilter& f) {
      f.kind = kind;
      f.frequency_hz = 0.0;
      f.numerator = std::move(numerator);
      f.denominator = std::move(denominator);
    });
  };
  EXPECT_EQ(with(biquad, {1.0}, {1.0, 1.0}), "");
  EXPECT_EQ(with(biquad, {1.0}, {1.0}), "denominator");
  EXPECT_EQ(with(biquad, {1.0}, {1.0, -1.0}), "denominator");      // unstable
  EXPECT_EQ(with(biquad, {1.0}, {1.0, 1.0, 0.0}), "denominator");  // an integrator
  EXPECT_EQ(with(biquad, {1.0, 0.0}, {1.0, 1.0}), "numerator");    // static gain 0
  EXPECT_EQ(with(biquad, {-1.0}, {1.0, 1.0}), "numerator");        // pulls
  EXPECT_EQ(with(biquad, {1.0, 1.0, 1.0}, {1.0, 1.0}), "numerator");
  EXPECT_EQ(with(digital, {1.0}, {1.0, -0.5}), "");
  EXPECT_EQ(with(digital, {1.0}, {1.0, -1.0}), "denominator");
  EXPECT_EQ(with(digital, {1.0}, {1.0, -1.9, 0.95}), "");
  EXPECT_EQ(with(digital, {1.0}, {1.0, -2.0, 0.95}), "denominator");
  EXPECT_EQ(with(digital, {1.0, -1.0}, {1.0, -0.5}), "numerator");
  EXPECT_EQ(with(digital, {std::nan("")}, {1.0, -0.5}), "numerator");
  EXPECT_THROW((void)filter_section(filter(notch, 600.0), period), Error);
}

}  // namespace
}  // namespace zwidth
