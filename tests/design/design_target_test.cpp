#include "zwidth/design/design_target.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/any_user.hpp"

namespace zwidth {
namespace {

Device with(const Device& device, const std::string& key, double value) {
  DeviceParameters parameters = device.parameters();
  set_parameter(parameters, key, value);
  return Device(std::move(parameters));
}

// K_CR = b²(1-a)/(m(1-a) - abT) of a rigid device without delay, a = e^{-bT/m} (theory, section 2): the needed b.
TEST(DesignTarget, NeededDampingOfARigidDeviceIsTheClosedForm) {
  const DesignTargets targets = design_targets(Device(test::rigid_parameters()), {.stiffness = 20e3});
  for (const DesignTarget& each : targets.targets) {
    if (each.key != "body.body.damping") continue;
    ASSERT_TRUE(each.value_needed) << each.why;
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
        for (const DesignTarget& each : design_targets(device, {.stiffness = target}).targets) {
          const double cost = !each.value_needed     ? std::numeric_limits<double>::infinity()
                              : each.value_now > 0.0 ? std::abs(std::log(*each.value_needed / each.value_now))
                                                     : 1e300;
          EXPECT_GE(cost, last_cost) << "cheapest first: " << each.key;
          last_cost = cost;
          EXPECT_FALSE(each.why.empty());
          if (!each.value_needed) continue;
          const double there = critical_stiffness(with(device, each.key, *each.value_needed)).stiffness;
          const bool jumps = each.why.find("jumps") != std::string::npos;
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
      design_targets(device, {.stiffness = 6500.0, .goal = StiffnessGoal::any_user_limit, .factor = 10.0});
  EXPECT_NEAR(targets.limit_now.value(), 5776.09, 0.1);
  int found = 0;
  for (const DesignTarget& each : targets.targets) {
    EXPECT_FALSE(each.key.starts_with("operator."));
    if (!each.value_needed) continue;
    const Device changed = with(device, each.key, *each.value_needed);
    EXPECT_NEAR(any_user_limit(changed, virtual_damper(changed)).stiffness / 6500.0, 1.0, 1e-6) << each.key;
    ++found;
  }
  EXPECT_GE(found, 3);
}

TEST(DesignTarget, SaysInItsUnitWhyNoValueIsEnough) {
  for (const DesignTarget& each : design_targets(Device(test::lhifam_parameters()), {.stiffness = 20e3}).targets) {
    if (each.key == "body.motor.mass") {
      EXPECT_EQ(each.why, "within a factor of 1000 of its value the limit gets no higher than 10.14 kN/m");
    }
    if (each.key == "loop.delay") {
      EXPECT_EQ(each.why, "at any value from 0 up to what is likely the limit gets no higher than 8.849 kN/m");
    }
  }
}

TEST(DesignTarget, RefusesWhatItCannotDo) {
  const Device device(test::lhifam_parameters());
  EXPECT_EQ(find_problem(DesignTargetOptions{.stiffness = -1.0}, device)->member, "stiffness");
  EXPECT_EQ(find_problem(DesignTargetOptions{.stiffness = std::nan("")}, device)->member, "stiffness");
  EXPECT_EQ(find_problem(DesignTargetOptions{.stiffness = 1.0, .factor = 1.0}, device)->member, "factor");
  EXPECT_THROW((void)design_targets(device, {}), Error);
  const Device plant(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1.0));
  EXPECT_EQ(find_problem(DesignTargetOptions{.stiffness = 1.0, .goal = StiffnessGoal::any_user_limit}, plant)->member,
            "goal");
}

}  // namespace
}  // namespace zwidth
