// Sharp resonances whose aliases crowd at one sampled frequency: there the product of the terms' denominators is zero
// to rounding, in double-double too.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lhifam.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/worst_user.hpp"

namespace zwidth {
namespace {

double excess(const Device& device, double stiffness) {
  Wall wall = device.parameters().wall;
  wall.stiffness = stiffness;
  return stability_excess(sample(state_space(device), {device.loop().sampling_period, device.loop().delay}), wall);
}

// Light bodies on undamped springs, tuned `off` (relative) beside the aliases of one frequency.
Device crowded(double base, std::size_t absorbers, double mass, double off) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.loop.sensed = 1;
  UserNetwork user;
  for (std::size_t i = 0; i < absorbers; ++i) {
    const double alias = 2.0 * std::numbers::pi / 1e-3 * static_cast<double>((i + 1) / 2) + (i % 2 == 1 ? -base : base);
    const double frequency = alias * (1.0 + off);
    user.absorbers.push_back({mass, mass * frequency * frequency});
  }
  return held_by(Device(parameters), user);
}

TEST(CrowdedResonances, CriticalStiffnessIsWhereTheEigenvaluesLeave) {
  for (const std::size_t absorbers : {1u, 2u, 3u, 4u}) {
    for (const double mass : {1e-3, 1e-5}) {
      for (const double off : {1e-3, -1e-4, 1e-5}) {
        const Device device = crowded(184.8, absorbers, mass, off);
        const CriticalStiffness result = critical_stiffness(filtered_plant(device));
        if (result.stiffness == 0.0) {
          EXPECT_GT(excess(device, 1.0), 0.0);
          continue;
        }
        EXPECT_LT(excess(device, result.stiffness * (1.0 - 1e-4)), 1e-12) << absorbers << ' ' << mass << ' ' << off;
        EXPECT_GT(excess(device, result.stiffness * (1.0 + 1e-4)), 0.0) << absorbers << ' ' << mass << ' ' << off;
      }
    }
  }
}

// The absorbers of a worst user are such resonances: the pole it puts on the circle is a crossover.
TEST(CrowdedResonances, WorstUsersAreSeenByTheCriticalStiffness) {
  for (const std::size_t sensed : {0u, 1u}) {
    for (const double delay : {0.0, 0.25e-3, 0.6e-3}) {
      DeviceParameters parameters = test::lhifam_parameters();
      parameters.loop.sensed = sensed;
      parameters.loop.delay = delay;
      const Device device(parameters);
      const auto worst = worst_user(device, absolute_stability_limit(device));
      ASSERT_TRUE(worst);
      const CriticalStiffness result = critical_stiffness(filtered_plant(held_by(device, worst->user)));
      EXPECT_LE(result.stiffness, worst->critical_stiffness * (1.0 + 1e-6))
          << worst->user.absorbers.size() << " absorbers, sensed " << sensed << ", delay " << delay;
    }
  }
}

}  // namespace
}  // namespace zwidth
