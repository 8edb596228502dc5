#include "identification/verdict/turned_sign.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;

/// 60 lines from 1 to 100 Hz.
FrequencyResponse response_of(const std::function<Complex(Complex)>& transfer) {
  FrequencyResponse response;
  constexpr int lines = 60;
  for (int k = 0; k < lines; ++k) {
    const double frequency = 2.0 * std::numbers::pi * std::pow(100.0, static_cast<double>(k) / (lines - 1));
    response.points.push_back({.frequency = frequency, .value = transfer({0.0, frequency})});
  }
  return response;
}

void expect_told(const std::function<Complex(Complex)>& transfer) {
  const FrequencyResponse straight = response_of(transfer);
  ASSERT_TRUE(agreement_of_sign(straight));
  EXPECT_GT(*agreement_of_sign(straight), 0.6);
  EXPECT_FALSE(turned_sign(straight));
  const FrequencyResponse turned = response_of([&](Complex s) { return -transfer(s); });
  EXPECT_NEAR(*agreement_of_sign(turned), -*agreement_of_sign(straight), 1e-12);
  ASSERT_TRUE(turned_sign(turned));
  EXPECT_EQ(turned_sign(turned)->code, FindingCode::motion_against_force);
}

TEST(TurnedSign, IsToldOfABodyThatMovesFreely) {
  expect_told([](Complex s) { return std::exp(-2e-3 * s) / (s * (0.2 * s + 0.01)); });
  expect_told([](Complex s) { return std::exp(-2e-3 * s) / (s * (0.2 * s + 20.0)); });
}

TEST(TurnedSign, IsToldOfABodyOnASpring) {
  expect_told([](Complex s) { return 1.0 / (0.2 * s * s + 0.5 * s + 2000.0); });
}

TEST(TurnedSign, IsToldOfTwoBodiesWhicheverIsSensed) {
  const auto two_bodies = [](bool is_driven_sensed) {
    return [is_driven_sensed](Complex s) {
      const Complex link = 5000.0 + 0.5 * s;
      const Complex driven = s * (0.2 * s + 0.3) + link;
      const Complex held = s * (0.1 * s + 0.1) + link;
      return (is_driven_sensed ? held : link) / (driven * held - link * link);
    };
  };
  expect_told(two_bodies(true));
  expect_told(two_bodies(false));
}

TEST(TurnedSign, IsNotToldOfTwoLines) {
  FrequencyResponse response = response_of([](Complex s) { return 1.0 / (s * s); });
  response.points.resize(2);
  EXPECT_FALSE(agreement_of_sign(response));
  EXPECT_FALSE(turned_sign(response));
}

}  // namespace
}  // namespace zwidth::internal
