#include "signal/window_function.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

namespace zwidth {
using namespace internal;
namespace {

constexpr std::size_t length = 512;
constexpr Window windows[] = {Window::rectangular, Window::hann, Window::hamming, Window::blackman};

TEST(WindowFunction, CorrelationOfNoiseBetweenLinesIsThatOfTheSquaredWindow) {
  for (const Window window : windows) {
    const std::vector<double> w = window_function(window, length);
    double power = 0.0;
    for (const double value : w) power += value * value;
    for (std::size_t k = 0; k <= 5; ++k) {
      std::complex<double> sum;
      for (std::size_t i = 0; i < length; ++i) {
        sum += w[i] * w[i] * std::polar(1.0, 2.0 * std::numbers::pi * static_cast<double>(k * i) / length);
      }
      EXPECT_NEAR(noise_correlation(window, k), std::abs(sum) / power, 1e-12) << k;
    }
  }
}

TEST(WindowFunction, SecondMomentIsThatOfTheDerivative) {
  for (const Window window : {Window::hann, Window::blackman}) {
    const std::vector<double> w = window_function(window, length);
    double slope = 0.0;
    double power = 0.0;
    for (std::size_t i = 0; i < length; ++i) {
      const double difference = 0.5 * (w[(i + 1) % length] - w[(i + length - 1) % length]);
      const double per_radian = difference * length / (2.0 * std::numbers::pi);
      slope += per_radian * per_radian;
      power += w[i] * w[i];
    }
    EXPECT_NEAR(lobe_second_moment(window), slope / power, 1e-3);
  }
}

TEST(WindowFunction, SegmentsThatOverlapAreWorthFewerAndNoMoreThanTheyAre) {
  // Hann, half overlapping: neighbours' spectra of noise correlate by (1/6)^2 (Welch 1967).
  const std::vector<double> hann = window_function(Window::hann, length);
  EXPECT_DOUBLE_EQ(independent_segments(hann, 10, length), 10.0);
  EXPECT_NEAR(independent_segments(hann, 1000, length / 2), 1000.0 / (1.0 + 2.0 * 0.999 / 36.0), 1e-6);
  EXPECT_LT(independent_segments(hann, 1000, length / 8), 300.0);
}

}  // namespace
}  // namespace zwidth
