#include "zwidth/design/branch_switch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
namespace {

CriticalStiffness critical_at(DeviceParameters device, const std::string& key, double value) {
  set_parameter(device, key, value);
  return critical_stiffness(filtered_plant(Device(device)), {device.wall.damping, device.wall.velocity_filter_hz});
}

// On either side of a switch another crossover limits, and both have the K that it says.
TEST(BranchSwitch, IsWhereAnotherCrossoverTakesOver) {
  std::size_t found = 0;
  for (const DeviceParameters& device : {test::lhifam_parameters(), test::reduced_pretension_parameters(),
                                         test::with_delay(test::reduced_pretension_parameters(), 0.25e-3)}) {
    for (const BranchSwitch& each : branch_switches(Device(device))) {
      ++found;
      const double own = *parameter(device, each.key);
      const double outward = each.value > own ? 1.0 : -1.0;
      const CriticalStiffness before = critical_at(device, each.key, each.value * (1.0 - outward * 1e-6));
      const CriticalStiffness beyond = critical_at(device, each.key, each.value * (1.0 + outward * 1e-6));
      ASSERT_TRUE(before.limit && beyond.limit && each.beyond) << each.key;
      // Where a pair of crossovers is born or vanishes K moves like a square root, here of 1e-6.
      EXPECT_NEAR(before.stiffness / each.stiffness, 1.0, 5e-3) << each.key;
      EXPECT_NEAR(beyond.stiffness / each.stiffness_beyond, 1.0, 5e-3) << each.key;
      EXPECT_GT(std::abs(std::log(before.limit->frequency / beyond.limit->frequency)), 0.02) << each.key;
    }
  }
  EXPECT_GE(found, 3U);
}

// Theory, section 3.5: the cable at reduced pretension is limited by its mode, until a delay of less than 250 us brings
// a new crossover of the rigid body below.
TEST(BranchSwitch, ADelayBringsBackTheRigidBodyOfTheReducedPretension) {
  const auto switches = branch_switches(Device(test::reduced_pretension_parameters()));
  const auto delay =
      std::find_if(switches.begin(), switches.end(), [](const BranchSwitch& each) { return each.key == "loop.delay"; });
  ASSERT_NE(delay, switches.end());
  EXPECT_GT(delay->value, 0.0);
  EXPECT_LT(delay->value, 0.25e-3);
  EXPECT_GT(delay->before.frequency, 300.0);
  EXPECT_LT(delay->beyond->frequency, 100.0);
  EXPECT_LT(delay->stiffness_beyond, delay->stiffness);
}

TEST(BranchSwitch, ARigidDeviceHasNone) {
  for (const BranchSwitch& each : branch_switches(Device(test::rigid_parameters()))) {
    ADD_FAILURE() << each.key << " at " << each.value;
  }
}

// 1e-9/(s + 1000) has one crossover, at Nyquist: K + 2 B/T = 1/|P(-1)|. With more damping no wall is stable.
TEST(BranchSwitch, BeyondTheLastCrossoverNoWallIsStable) {
  DeviceParameters parameters;
  parameters.transfer_function = TransferFunction{{1e-9}, {1.0, 1000.0}};
  parameters.loop.sampling_period = 1e-3;
  const Device device(parameters);
  const double largest = 0.5 * parameters.loop.sampling_period * critical_stiffness(device).stiffness;
  const auto switches = branch_switches(device);
  const auto found = std::ranges::find(switches, "wall.damping", &BranchSwitch::key);
  ASSERT_NE(found, switches.end());
  EXPECT_NEAR(found->value / largest, 1.0, 1e-6);
  EXPECT_EQ(found->stiffness_beyond, 0.0);
  EXPECT_FALSE(found->beyond);
}

TEST(BranchSwitch, RefusesAFactorThatDoesNotMove) {
  EXPECT_THROW((void)branch_switches(Device(test::rigid_parameters()), {.factor = 1.0}), Error);
}

}  // namespace
}  // namespace zwidth
