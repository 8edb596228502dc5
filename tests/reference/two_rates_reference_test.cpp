// 40 devices whose spring and damper run at two rates, computed elsewhere by eigenvalues of the exact loop.

#include <gtest/gtest.h>

#include "reference/two_rate_devices.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

constexpr double relative_tolerance = 1e-9;

void expect_limit(const CriticalStiffness& found, double reference) {
  EXPECT_TRUE(found.trust.sound()) << (found.trust.reasons.empty() ? "" : found.trust.reasons.front());
  if (reference == 0.0) {
    EXPECT_EQ(found.status, StiffnessStatus::none_stable);
    EXPECT_EQ(found.stiffness, 0.0);
    return;
  }
  ASSERT_EQ(found.status, StiffnessStatus::finite);
  EXPECT_NEAR(found.stiffness / reference, 1.0, relative_tolerance) << found.stiffness << " for " << reference;
  ASSERT_FALSE(found.stable_intervals.empty());
  EXPECT_EQ(found.stable_intervals.front().upper, found.stiffness);
}

TEST(TwoRatesReference, EveryDevice) {
  const nlohmann::json cases = test::two_rate_cases();
  ASSERT_EQ(cases.size(), 40U);
  for (const auto& each : cases) {
    DeviceParameters parameters = test::two_rate_parameters(each);
    SCOPED_TRACE(parameters.name);
    expect_limit(critical_stiffness(Device(parameters)), each.at("critical_stiffness"));
    parameters.wall.damping = 0.0;
    expect_limit(critical_stiffness(Device(parameters)), each.at("critical_stiffness_without_damper"));
  }
}

}  // namespace
}  // namespace zwidth
