// A hundred random devices whose damper has a loop of its own, in time.

#include <gtest/gtest.h>

#include "property/random_two_rates.hpp"

namespace zwidth {
namespace {

TEST(TwoRatesInTimeProperty, AHundredGrowAboveTheCriticalStiffnessAndDecayBelow) {
  test::RandomTwoRates devices(20261128);
  int compared = 0;
  int drawn = 0;
  for (; compared < 100 && drawn < 400; ++drawn) {
    const Device device = devices.next();
    SCOPED_TRACE(device.name());
    compared += test::compare_in_time(device) ? 1 : 0;
  }
  EXPECT_EQ(compared, 100) << "of " << drawn;
  RecordProperty("drawn", drawn);
}

}  // namespace
}  // namespace zwidth
