#include "zwidth/control/velocity_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

constexpr double period = 1e-3;

TEST(VelocityFilter, IsTheBackwardDifferenceWithoutALowPass) {
  VelocityFilter filter(0.0, period);
  EXPECT_EQ(filter.update(0.3), 0.0);  // at rest before
  EXPECT_NEAR(filter.update(0.301), 1.0, 1e-12);
  EXPECT_NEAR(filter.update(0.2985), -2.5, 1e-12);
  EXPECT_EQ(filter.update(0.2985), 0.0);
}

// v[k] after a step of velocity from 0 to 1 is 1 - a^k.
TEST(VelocityFilter, ApproachesASteadyVelocityByItsPole) {
  VelocityFilter filter(50.0, period);
  const double a = std::exp(-2.0 * std::numbers::pi * 50.0 * period);
  (void)filter.update(0.0);
  for (int k = 1; k < 200; ++k) EXPECT_NEAR(filter.update(k * period), 1.0 - std::pow(a, k), 1e-12) << k;
}

TEST(VelocityFilter, ResetForgets) {
  VelocityFilter filter(50.0, period);
  (void)filter.update(0.0);
  (void)filter.update(1.0);
  filter.reset();
  EXPECT_EQ(filter.update(7.0), 0.0);
  EXPECT_EQ(filter.update(7.0), 0.0);
}

TEST(VelocityFilter, RefusesWhatIsNoFrequencyAndNoPeriod) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double cutoff : {-1.0, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(VelocityFilter(cutoff, period), Error) << cutoff;
  }
  for (const double wrong : {0.0, -1e-3, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(VelocityFilter(10.0, wrong), Error) << wrong;
  }
}

}  // namespace
}  // namespace zwidth
