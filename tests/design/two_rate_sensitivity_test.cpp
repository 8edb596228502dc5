// Sensitivities of devices whose damper runs in a loop of its own, against limits that are solved again.

#include "design/sensitivities/two_rate_sensitivity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "lhifam.hpp"
#include "reference/two_rate_devices.hpp"
#include "zwidth/design/branch_switch.hpp"
#include "zwidth/design/design.hpp"
#include "zwidth/design/sensitivity.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

double limit_with(const DeviceParameters& parameters, const std::string& key, double value) {
  DeviceParameters moved = parameters;
  internal::set_with_ratio(moved, key, value);
  return critical_stiffness(Device(moved)).stiffness;
}

bool has(const std::vector<Sensitivity>& all, const std::string& key) {
  return std::ranges::any_of(all, [&](const Sensitivity& each) { return each.key == key; });
}

TEST(TwoRateSensitivity, IsThatOfLimitsSolvedAgain) {
  constexpr double step = 3e-5;
  std::size_t index = 0;
  for (const auto& each : test::two_rate_cases()) {
    if (index++ % 8 != 0) continue;
    const DeviceParameters parameters = test::two_rate_parameters(each);
    SCOPED_TRACE(parameters.name);
    const CriticalStiffness own = critical_stiffness(Device(parameters));
    const std::vector<Sensitivity> found = stiffness_sensitivities(Device(parameters), own);
    if (!own.limit) {
      EXPECT_TRUE(found.empty());
      continue;
    }
    EXPECT_TRUE(has(found, "loop.sampling_period"));
    EXPECT_TRUE(has(found, "loop.delay"));
    EXPECT_TRUE(has(found, "loop.damper.delay"));
    EXPECT_TRUE(has(found, "wall.damping"));
    EXPECT_FALSE(has(found, "loop.damper.sampling_period"));
    for (const Sensitivity& of : found) {
      if (of.value == 0.0) continue;
      const double above = limit_with(parameters, of.key, of.value * (1.0 + step));
      const double far_above = limit_with(parameters, of.key, of.value * (1.0 + 2.0 * step));
      // Where a force arrives just with a sample the slope is that of growing numbers.
      const double slope = (4.0 * above - far_above - 3.0 * own.stiffness) / (2.0 * step * own.stiffness);
      EXPECT_NEAR(of.relative.value(), slope, 1e-6 * std::max(1.0, std::abs(slope))) << of.key;
    }
  }
}

// Twice as fast in everything is twice the damping and four times the stiffness: Euler's relation of the limit K(m, b, k, T).
TEST(TwoRateSensitivity, KeepsUnits) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.loop.damper = LoopDamper{2e-4, 3e-5};
  parameters.loop.delay = 4e-4;
  parameters.wall.damping = 100.0;
  double of_time = 0.0;
  double of_force = 0.0;
  for (const Sensitivity& each : stiffness_sensitivities(Device(parameters))) {
    if (each.value == 0.0) continue;
    const bool is_time = each.key.starts_with("loop.");
    const bool is_mass = each.key.ends_with(".mass");
    const bool is_damping = each.key.ends_with(".damping");
    if (!is_time) of_force += *each.relative;
    of_time += *each.relative * (is_time ? 1.0 : is_mass ? 2.0 : is_damping ? 1.0 : 0.0);
  }
  EXPECT_NEAR(of_force, 1.0, 1e-6);  // all forces doubled
  EXPECT_NEAR(of_time, 0.0, 1e-6);   // all times doubled, springs as they are
}

TEST(TwoRateSensitivity, OfADamperThatDoesNothingIsThatOfOneRate) {
  DeviceParameters parameters = test::lhifam_parameters();
  const std::vector<Sensitivity> one = stiffness_sensitivities(Device(parameters));
  parameters.loop.damper = LoopDamper{1e-4, 0.0};
  const std::vector<Sensitivity> two = stiffness_sensitivities(Device(parameters));
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].key, two[i].key);
    EXPECT_EQ(one[i].slope, two[i].slope);
  }
}

TEST(TwoRateSensitivity, FindsAnotherMechanismTakingOver) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.loop.damper = LoopDamper{1e-4, 0.0};
  parameters.wall.damping = 5.0;
  const std::vector<BranchSwitch> switches = branch_switches(Device(parameters));
  const auto of_damping =
      std::ranges::find(switches, std::string("wall.damping"), [](const BranchSwitch& each) { return each.key; });
  ASSERT_NE(of_damping, switches.end());
  // Where two branches of the boundary cross.
  EXPECT_NEAR(of_damping->value, 11.5121287, 1e-5);
  EXPECT_NEAR(of_damping->stiffness / of_damping->stiffness_beyond, 1.0, 1e-6);
}

// Differences of the limit found anew, whose least value moves over frequency.
TEST(TwoRateSensitivity, OfAllUsersIsThatOfTheirLimit) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.loop.damper = LoopDamper{1e-4, 0.0};
  parameters.wall.damping = 200.0;
  const Device device(parameters);
  const Design found = design(device, {.branch_switches = false});
  const std::vector<Sensitivity> alone = stiffness_sensitivities(device);
  ASSERT_EQ(found.sensitivities.size(), alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_EQ(found.sensitivities[i].slope, alone[i].slope);
  ASSERT_TRUE(found.analysis.any_user);
  const double limit = found.analysis.any_user->stiffness;
  const auto limit_with = [&](const std::string& key, double value) {
    DeviceParameters moved = parameters;
    if (key == "loop.sampling_period") *moved.loop.damper->sampling_period *= value / moved.loop.sampling_period;
    set_parameter(moved, key, value);
    return analyze(Device(std::move(moved))).any_user->stiffness;
  };
  int compared = 0;
  for (const Sensitivity& each : found.absolute_stability_sensitivities) {
    SCOPED_TRACE(each.key);
    // The spring's delay alone leaves the limit unknown.
    EXPECT_FALSE(each.key == "loop.delay" || each.key == "loop.damper.delay" || each.key.starts_with("operator."));
    if (each.value == 0.0) continue;
    const double step = 1e-3 * each.value;
    const double slope =
        (limit_with(each.key, each.value + step) - limit_with(each.key, each.value - step)) / (2.0 * step);
    EXPECT_NEAR(each.slope, slope, 1e-4 * limit / each.value);
    ++compared;
  }
  EXPECT_GE(compared, 7);
}

TEST(TwoRateSensitivity, OfAllUsersHasOneDelayWhereBothMove) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.loop.delay = 0.3e-4;
  parameters.loop.damper = LoopDamper{1e-4, std::nullopt};
  parameters.wall.damping = 200.0;
  const std::vector<Sensitivity> found = absolute_stability_sensitivities(Device(parameters));
  const Sensitivity* delay = find_sensitivity(found, "loop.delay");
  ASSERT_NE(delay, nullptr);
  const auto limit_with = [&](double value) {
    DeviceParameters moved = parameters;
    moved.loop.delay = value;
    return analyze(Device(std::move(moved))).any_user->stiffness;
  };
  const double step = 1e-7;
  const double slope = (limit_with(0.3e-4 + step) - limit_with(0.3e-4 - step)) / (2.0 * step);
  EXPECT_NEAR(delay->slope / slope, 1.0, 1e-3);
}

}  // namespace
}  // namespace zwidth
