#include "zwidth/design/design_target.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_damping.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth {
namespace {

Device with(const Device& device, const std::string& key, double value) {
  DeviceParameters parameters = device.parameters();
  set_parameter(parameters, key, value);
  return Device(std::move(parameters));
}

// K_CR = b²(1-a)/(m(1-a) - abT) of a rigid device without delay, a = e^{-bT/m}
// (docs/theory.md, "Critical stiffness"): the needed b.
TEST(DesignTarget, NeededDampingOfARigidDeviceIsTheClosedForm) {
  const DesignTargets targets = design_targets(Device(test::rigid_parameters()), {.stiffness = 20e3});
  for (const DesignTarget& each : targets.targets) {
    if (each.key != "body.body.damping") continue;
    ASSERT_TRUE(each.value_needed) << text(each.why);
    const double b = *each.value_needed;
    const double a = std::exp(-b * 1e-3 / 5.4);
    EXPECT_NEAR(b * b * (1.0 - a) / (5.4 * (1.0 - a) - a * b * 1e-3) / 20e3, 1.0, 1e-6);
    return;
  }
  FAIL() << "body.body.damping is not among the targets";
}

// On either side of the needed value the limit is on either side of the target; at it, within 1e-9 or at a jump.
TEST(DesignTarget, EveryNeededValueIsConfirmed) {
  test::RandomDevices random(20261122);
  int confirmed = 0;
  for (const std::string_view kind : {"two_mass", "fractional_delay", "virtual_damper", "three_mass", "rigid"}) {
    for (int i = 0; i < 4; ++i) {
      const Device device(random.device(kind));
      const CriticalStiffness now = critical_stiffness(device);
      if (now.status != StiffnessStatus::finite) continue;
      for (const double factor : {0.7, 1.6}) {
        const double target = factor * now.stiffness;
        double last_cost = 0.0;
        bool lowers_users = false;
        for (const DesignTarget& each : design_targets(device, {.stiffness = target}).targets) {
          const double cost = !each.value_needed     ? std::numeric_limits<double>::infinity()
                              : each.value_now > 0.0 ? std::abs(std::log(*each.value_needed / each.value_now))
                                                     : 1e300;
          const bool lowers = each.value_needed && !each.safe.value_or(true);
          if (lowers == lowers_users) {
            EXPECT_GE(cost, last_cost) << "cheapest first: " << each.key;
          }
          last_cost = cost;
          lowers_users = lowers;
          EXPECT_NE(each.why.code, FindingCode::stated);
          if (!each.value_needed) continue;
          const double there = critical_stiffness(with(device, each.key, *each.value_needed)).stiffness;
          const bool jumps = each.why.code == FindingCode::limit_jumps_across_target;
          if (jumps) {
            const auto reached = [&](double share) {
              return critical_stiffness(with(device, each.key, *each.value_needed * share)).stiffness >= target;
            };
            EXPECT_GE(there, target);
            EXPECT_NE(reached(1.0 - 1e-7), reached(1.0 + 1e-7)) << kind << " " << each.key;
          } else {
            EXPECT_NEAR(there / target, 1.0, 1e-9) << kind << " " << each.key;
          }
          ++confirmed;
        }
      }
    }
  }
  EXPECT_GT(confirmed, 100);
}

TEST(DesignTarget, OfTheLimitWithAnyUser) {
  const Device device(test::lhifam_parameters());
  const DesignTargets targets =
      design_targets(device, {.stiffness = 6500.0, .goal = StiffnessGoal::absolute_stability_limit, .factor = 10.0});
  EXPECT_NEAR(targets.limit_now.value(), 5776.09, 0.1);
  int found = 0;
  for (const DesignTarget& each : targets.targets) {
    EXPECT_FALSE(each.key.starts_with("operator."));
    if (!each.value_needed) continue;
    const Device changed = with(device, each.key, *each.value_needed);
    EXPECT_NEAR(absolute_stability_limit(changed, virtual_damper(changed)).stiffness / 6500.0, 1.0, 1e-6) << each.key;
    ++found;
  }
  EXPECT_GE(found, 3);
}

DeviceParameters two_bodies(double motor, double motor_damping, double handle, double handle_damping, double stiffness,
                            double damping) {
  DeviceParameters parameters;
  parameters.name = "two bodies";
  parameters.bodies = {{"motor", motor, motor_damping}, {"handle", handle, handle_damping}};
  parameters.links = {{0, 1, stiffness, damping}};
  parameters.loop = {0, 0, 1, 1e-3, 0.0};
  return parameters;
}

// Six of the numbers and the virtual damper are followed, by a factor of 10; the others stand last and are said to be left out.
TEST(DesignTarget, OfManyBodiesThoseThatMoveTheLimitMostAreFollowed) {
  DeviceParameters parameters;
  for (std::size_t i = 0; i < 6; ++i) {
    parameters.bodies.push_back({"b" + std::to_string(i), 0.5, 2.0, 0.0, 0.0});
    if (i > 0) parameters.links.push_back({i - 1, i, 1e5, 5.0});
  }
  parameters.loop.sampling_period = 1e-3;
  parameters.loop.held = 5;
  const Device device(parameters);
  const double target = 1.2 * absolute_stability_limit(device).stiffness;
  const DesignTargets found =
      design_targets(device, {.stiffness = target, .goal = StiffnessGoal::absolute_stability_limit});
  ASSERT_EQ(found.remarks.size(), 1U);
  std::size_t reached = 0;
  for (const DesignTarget& each : found.targets) {
    if (!each.value_needed) continue;
    ++reached;
    if (each.value_now > 0.0) {
      EXPECT_LE(std::abs(std::log(*each.value_needed / each.value_now)), std::log(10.0) * (1.0 + 1e-12)) << each.key;
    }
    DeviceParameters moved = parameters;
    set_parameter(moved, each.key, *each.value_needed);
    const Device there(moved);
    EXPECT_NEAR(absolute_stability_limit(there, virtual_damper(there)).stiffness / target, 1.0, 1e-6) << each.key;
  }
  EXPECT_GE(reached, 1U);
  EXPECT_LE(reached, 7U);
  EXPECT_GT(found.targets.size(), 20U);
}

// A cable of a tenth of its stiffness doubles the limit of the device that nobody holds, and gives no user anything.
TEST(DesignTarget, EachProposalIsJudgedForAnyUserAndWhatLowersThatLimitComesLast) {
  const Device device(two_bodies(0.145, 0.0102, 0.233, 0.268, 50.9e3, 8.79));
  const double nobody = critical_stiffness(device).stiffness;
  const double any_user = absolute_stability_limit(device).stiffness;
  const DesignTargets targets = design_targets(device, {.stiffness = 2.0 * nobody});
  EXPECT_DOUBLE_EQ(targets.absolute_stability_limit_now.value(), any_user);
  int lowering = 0;
  bool lowers_before = false;
  for (const DesignTarget& each : targets.targets) {
    SCOPED_TRACE(each.key);
    ASSERT_EQ(each.safe.has_value(), each.value_needed.has_value());
    if (!each.value_needed) continue;
    const Device changed = with(device, each.key, *each.value_needed);
    const AbsoluteStabilityLimit then = absolute_stability_limit(changed, virtual_damper(changed));
    EXPECT_NEAR(*each.absolute_stability_limit_then / then.stiffness, 1.0, 1e-9);
    EXPECT_EQ(*each.safe, then.stiffness * (1.0 + then.truncation) >= any_user * (1.0 - 1e-9));
    EXPECT_FALSE(lowers_before && *each.safe) << "what lowers it comes last";
    lowers_before = lowers_before || !*each.safe;
    if (each.key == "link.0.stiffness") {
      EXPECT_NEAR(*each.value_needed / 50.9e3, 0.095, 0.001);
      EXPECT_FALSE(*each.safe);
      ++lowering;
    }
  }
  EXPECT_EQ(lowering, 1);
}

// A hand of steel was offered.
TEST(DesignTarget, WhoHoldsTheDeviceIsNoPartOfIt) {
  DeviceParameters held = test::lhifam_parameters();
  held.user = {0.5, 6.0, 135.0};
  for (const DesignTarget& each : design_targets(Device(held), {.stiffness = 12e3}).targets) {
    EXPECT_FALSE(each.key.starts_with("operator.")) << each.key;
  }
}

TEST(DesignTarget, AMultipleIsOfTodaysLimit) {
  const Device device(test::lhifam_parameters());
  const DesignTargets twice = design_targets(device, {.times_now = 2.0});
  EXPECT_DOUBLE_EQ(twice.target.value(), 2.0 * critical_stiffness(device).stiffness);
  const DesignTargets same = design_targets(device, {.stiffness = *twice.target});
  ASSERT_EQ(twice.targets.size(), same.targets.size());
  for (std::size_t i = 0; i < same.targets.size(); ++i) {
    EXPECT_EQ(twice.targets[i].key, same.targets[i].key);
    EXPECT_EQ(twice.targets[i].value_needed, same.targets[i].value_needed);
  }
  // Nothing to multiply: without damping no wall is stable.
  const DesignTargets none =
      design_targets(Device(two_bodies(0.005, 0.0, 0.005, 0.0, 700.0, 0.01)), {.times_now = 2.0});
  EXPECT_FALSE(none.target);
  EXPECT_TRUE(none.targets.empty());
  EXPECT_EQ(none.remarks.size(), 1U);
}

// Of a damper alone.
TEST(DesignTarget, OfTheLargestDamper) {
  const Device device(test::lhifam_parameters());
  const double now = critical_damping(device).damping;
  const double any_user = absolute_stability_damping(device).damping;
  for (const StiffnessGoal goal : {StiffnessGoal::critical_stiffness, StiffnessGoal::absolute_stability_limit}) {
    const DesignTargets targets =
        design_targets(device, {.goal = goal, .factor = 10.0, .times_now = 1.5, .limit_of = WallNumber::damping});
    const bool of_users = goal == StiffnessGoal::absolute_stability_limit;
    EXPECT_DOUBLE_EQ(targets.limit_now.value(), of_users ? std::min(now, any_user) : now);
    EXPECT_DOUBLE_EQ(targets.absolute_stability_limit_now.value(), any_user);
    int found = 0;
    for (const DesignTarget& each : targets.targets) {
      SCOPED_TRACE(each.key);
      EXPECT_NE(each.key, "wall.damping");
      if (!each.value_needed || each.why.code == FindingCode::limit_jumps_across_target) continue;
      const Device changed = with(device, each.key, *each.value_needed);
      const double users_then = absolute_stability_damping(changed).damping;
      EXPECT_NEAR((of_users ? users_then : critical_damping(changed).damping) / *targets.target, 1.0, 1e-6);
      EXPECT_NEAR(*each.absolute_stability_limit_then / users_then, 1.0, 1e-9);
      EXPECT_EQ(each.safe.value(), *each.absolute_stability_limit_then >= any_user * (1.0 - 1e-9));
      ++found;
    }
    EXPECT_GE(found, 2);
  }
}

TEST(DesignTarget, SaysInItsUnitWhyNoValueIsEnough) {
  for (const DesignTarget& each : design_targets(Device(test::lhifam_parameters()), {.stiffness = 20e3}).targets) {
    if (each.key == "body.motor.mass") {
      EXPECT_EQ(text(each.why), "within a factor of 1000 of its value the limit gets no higher than 10.14 kN/m");
    }
    if (each.key == "loop.delay") {
      EXPECT_EQ(each.why.code, FindingCode::limit_stays_below_target);
      EXPECT_EQ(text(each.why), "at any value from 0 up to what is likely the limit gets no higher than 8.849 kN/m");
    }
  }
}

TEST(DesignTarget, RefusesWhatItCannotDo) {
  const Device device(test::lhifam_parameters());
  EXPECT_EQ(find_problem(DesignTargetOptions{.stiffness = -1.0}, device)->member, "stiffness");
  EXPECT_EQ(find_problem(DesignTargetOptions{.stiffness = std::nan("")}, device)->member, "stiffness");
  EXPECT_EQ(find_problem(DesignTargetOptions{.stiffness = 1.0, .factor = 1.0}, device)->member, "factor");
  EXPECT_EQ(find_problem(DesignTargetOptions{.times_now = -2.0}, device)->member, "times_now");
  EXPECT_FALSE(find_problem(DesignTargetOptions{.times_now = 2.0}, device));
  EXPECT_THROW((void)design_targets(device, {}), Error);
  const Device plant(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1.0));
  EXPECT_EQ(find_problem(DesignTargetOptions{.stiffness = 1.0, .goal = StiffnessGoal::absolute_stability_limit}, plant)
                ->member,
            "goal");
}

}  // namespace
}  // namespace zwidth
