#include "zwidth/stability/bode_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace zwidth {
namespace {

using Complex = std::complex<double>;

/// A lone mode, unit mass.
DelayedResponse mode_response(double frequency, double ratio, double delay = 0.0) {
  return {[=](double w) { return 1.0 / Complex(frequency * frequency - w * w, 2.0 * ratio * frequency * w); }, delay};
}

std::vector<double> frequencies_of(const DelayedResponse& response, FrequencyRange range, const Mode& mode) {
  return bode_frequencies({&response, 1}, range, {&mode, 1}, 0.0, 50);
}

TEST(BodePoints, ALightPeakBetweenGridPointsIsMet) {
  constexpr double frequency = 123.456;
  constexpr double ratio = 1e-4;
  const DelayedResponse response = mode_response(frequency, ratio);
  const auto points = bode_points(response, frequencies_of(response, {1.0, 1e4}, {frequency, ratio}));
  double peak = -1e9;
  for (const BodePoint& point : points) peak = std::max(peak, point.magnitude_db);
  EXPECT_NEAR(peak, -20.0 * std::log10(2.0 * ratio * frequency * frequency), 0.01);
}

TEST(BodePoints, ALightZeroIsMetWithoutBeingNamed) {
  // (s² + 2 zeta w s + w²) / s^4, the zero between grid points.
  constexpr double frequency = 321.0;
  constexpr double ratio = 1e-3;
  const DelayedResponse response{
      [](double w) { return Complex(frequency * frequency - w * w, 2.0 * ratio * frequency * w) / std::pow(w, 4); },
      0.0};
  const auto frequencies = bode_frequencies({&response, 1}, {1.0, 1e3}, {}, 0.0, 50);
  double least = 1e9;
  for (const BodePoint& point : bode_points(response, frequencies)) least = std::min(least, point.magnitude_db);
  EXPECT_NEAR(least, 20.0 * std::log10(2.0 * ratio / (frequency * frequency)), 0.3);
}

TEST(BodePoints, FrequenciesRiseWithinTheRange) {
  const DelayedResponse response = mode_response(50.0, 0.01);
  const auto frequencies = frequencies_of(response, {1.0, 1e3}, {50.0, 0.01});
  EXPECT_EQ(frequencies.front(), 1.0);
  EXPECT_EQ(frequencies.back(), 1e3);
  EXPECT_TRUE(std::is_sorted(frequencies.begin(), frequencies.end(), std::less_equal<>()));
  EXPECT_LT(frequencies.size(), 1000U);
}

TEST(BodePoints, PhaseIsUnwrappedThroughAModeAndALongDelay) {
  constexpr double delay = 0.05;
  const DelayedResponse response = mode_response(50.0, 0.02, delay);
  const auto points = bode_points(response, frequencies_of(response, {0.1, 1e4}, {50.0, 0.02}));
  EXPECT_NEAR(points.front().phase_deg, -0.1 * delay * 180.0 / std::numbers::pi, 0.01);
  EXPECT_NEAR(points.back().phase_deg, -180.0 - 1e4 * delay * 180.0 / std::numbers::pi, 0.1);
  for (const BodePoint& point : points) EXPECT_LT(point.phase_deg, 0.0);
}

TEST(BodePoints, AnUndampedModeLowersThePhaseByHalfATurn) {
  const DelayedResponse response = mode_response(50.0, 0.0);
  const auto points = bode_points(response, frequencies_of(response, {1.0, 1e3}, {50.0, 0.0}));
  EXPECT_NEAR(points.front().phase_deg, 0.0, 1e-9);
  EXPECT_NEAR(points.back().phase_deg, -180.0, 1e-9);
  for (const BodePoint& point : points) EXPECT_TRUE(std::isfinite(point.magnitude_db));
}

TEST(BodePoints, AFreeMassStartsAtMinusHalfATurn) {
  const DelayedResponse mass{[](double w) { return Complex(-1.0 / (w * w), 1e-12); }, 0.0};
  EXPECT_NEAR(bode_points(mass, std::array{1.0}).front().phase_deg, -180.0, 1e-6);
}

}  // namespace
}  // namespace zwidth
