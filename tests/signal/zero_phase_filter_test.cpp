#include "signal/zero_phase_filter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "zwidth/error.hpp"

namespace zwidth {
using namespace internal;
namespace {

TEST(ZeroPhaseFilter, SinesKeepTheirPhaseAndGetTheDocumentedGain) {
  constexpr double cutoff = 0.04;
  for (const double frequency : {0.005, 0.02, 0.04, 0.06, 0.1}) {
    std::vector<double> sine(4000);
    for (std::size_t k = 0; k < sine.size(); ++k) {
      sine[k] = std::sin(2.0 * std::numbers::pi * frequency * static_cast<double>(k));
    }
    const std::vector<double> filtered = zero_phase_low_pass(sine, cutoff);
    const double ratio = std::tan(std::numbers::pi * frequency) / std::tan(std::numbers::pi * cutoff);
    const double gain = 1.0 / (1.0 + std::pow(ratio, 8.0));
    for (std::size_t k = 500; k < 3500; ++k) ASSERT_NEAR(filtered[k], gain * sine[k], 1e-9) << frequency;
  }
}

TEST(ZeroPhaseFilter, StraightLinesPassUnchangedEndsIncluded) {
  std::vector<double> line(500);
  for (std::size_t k = 0; k < line.size(); ++k) line[k] = 3.0 - 0.25 * static_cast<double>(k);
  const std::vector<double> filtered = zero_phase_low_pass(line, 0.05);
  // What is left of the start's transient after six periods of the cutoff, on a line that falls by 125.
  for (std::size_t k = 0; k < line.size(); ++k) EXPECT_NEAR(filtered[k], line[k], 1e-5) << k;
  const std::vector<double> constant = zero_phase_low_pass(std::vector<double>(50, 7.0), 0.2);
  for (const double each : constant) EXPECT_NEAR(each, 7.0, 1e-13);
}

TEST(ZeroPhaseFilter, AgreesWithSciPy) {
  // scipy 1.10: sosfiltfilt(butter(4, 2 cutoff, output='sos'), x, padtype='odd', padlen=min(39, ceil(6/cutoff)))
  std::vector<double> signal(40);
  for (std::size_t k = 0; k < signal.size(); ++k) {
    const auto t = static_cast<double>(k);
    signal[k] = std::sin(0.3 * t) + 0.02 * std::pow(t, 1.5) + (k % 7 == 3 ? 1.0 : 0.0);
  }
  constexpr std::array<std::size_t, 6> at{0, 1, 5, 20, 38, 39};
  constexpr std::array slow{0.00023782958143264178, 0.24962695253132977, 0.968359177433521,
                            1.7163204933318752,     4.0435831858986075,  4.102783236355486};
  constexpr std::array fast{9.665901373745456e-07, 0.4464085180439318, 1.3141144007410928,
                            1.406426471531952,     4.112004950166476,  4.109111975196072};
  const std::vector<double> slow_filtered = zero_phase_low_pass(signal, 0.05);
  const std::vector<double> fast_filtered = zero_phase_low_pass(signal, 0.2);
  for (std::size_t i = 0; i < at.size(); ++i) {
    EXPECT_NEAR(slow_filtered[at[i]], slow[i], 1e-11);
    EXPECT_NEAR(fast_filtered[at[i]], fast[i], 1e-11);
  }
}

TEST(ZeroPhaseFilter, RefusesACutoffOutsideItsDomain) {
  const std::vector<double> signal(10, 1.0);
  for (const double bad : {0.0, -0.1, 0.5, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW((void)zero_phase_low_pass(signal, bad), Error);
  }
  EXPECT_TRUE(zero_phase_low_pass({}, 0.1).empty());
}

}  // namespace
}  // namespace zwidth
