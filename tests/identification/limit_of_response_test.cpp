#include "identification/limit_of_response.hpp"

#include <gtest/gtest.h>

#include "identification/synthetic_response.hpp"
#include "lhifam.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {
namespace {

/// Around the crossover at 6.1 Hz of LHIfAM's 8849 N/m.
FrequencyResponse response_of_lhifam() {
  return test::synthetic_response(Device(test::lhifam_parameters()), 1.0, 50.0, 491, {1e-3, 1});
}

// A structure that leaves something, and is sure of another limit than the response shows.
TEST(LimitOfResponse, BelongsToTheInterval) {
  const Device device(test::lhifam_parameters());
  const double limit = critical_stiffness(device).stiffness;
  const Interval above = with_limit_of_response({0.7 * limit, 0.8 * limit}, response_of_lhifam(), device, {});
  EXPECT_EQ(above.lower, 0.7 * limit);
  EXPECT_GT(above.upper, limit);
  EXPECT_LT(above.upper, 1.2 * limit);
  const Interval below = with_limit_of_response({1.2 * limit, 1.3 * limit}, response_of_lhifam(), device, {});
  EXPECT_LT(below.lower, limit);
  EXPECT_GT(below.lower, 0.8 * limit);
  EXPECT_EQ(below.upper, 1.3 * limit);
}

TEST(LimitOfResponse, OfAnotherLoopSaysNothing) {
  const Device device(test::lhifam_parameters());
  const Interval fitted{1.0, 2.0};
  const auto is_as_it_was = [&](const Interval& found) { return found.lower == 1.0 && found.upper == 2.0; };
  EXPECT_TRUE(is_as_it_was(with_limit_of_response(fitted, response_of_lhifam(), device, {"handle"})));
  DeviceParameters faster = test::lhifam_parameters();
  faster.loop.sampling_period *= 0.5;
  EXPECT_TRUE(is_as_it_was(with_limit_of_response(fitted, response_of_lhifam(), Device(faster), {})));
  FrequencyResponse continuous = response_of_lhifam();
  continuous.sampling_period.reset();
  EXPECT_TRUE(is_as_it_was(with_limit_of_response(fitted, continuous, device, {})));
}

// Where the band ends below the crossover.
TEST(LimitOfResponse, OutsideTheBandSaysNothing) {
  const Device device(test::lhifam_parameters());
  const FrequencyResponse low = test::synthetic_response(device, 0.5, 3.0, 26, {1e-3, 1});
  const Interval found = with_limit_of_response({1.0, 2.0}, low, device, {});
  EXPECT_EQ(found.lower, 1.0);
  EXPECT_EQ(found.upper, 2.0);
}

}  // namespace
}  // namespace zwidth::internal
