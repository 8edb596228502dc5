// A hub with several branches alike: it moves them together, and what they do against each other neither hub nor wall
// sees. n branches of m, b, k are one of n m, n b, n k to it.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "campaign.hpp"
#include "exact_closed_loop.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

struct Branch {
  Body body;
  Link link;
};

DeviceParameters with_branches(DeviceParameters hub, const Branch& branch, std::size_t count) {
  for (std::size_t i = 1; i <= count; ++i) {
    hub.bodies.push_back(branch.body);
    hub.bodies.back().name = "branch " + std::to_string(i);
    hub.links.push_back(branch.link);
    hub.links.back().first = 0;
    hub.links.back().second = i;
  }
  return hub;
}

Branch times(const Branch& branch, double n) {
  Branch result = branch;
  result.body.mass *= n;
  result.body.damping *= n;
  result.body.stiffness *= n;
  result.link.stiffness *= n;
  result.link.damping *= n;
  return result;
}

struct Hub {
  DeviceParameters alone;
  Branch branch;
};

Hub random_hub(unsigned seed) {
  std::mt19937_64 random(seed);
  const auto log_uniform = [&](double least, double most) {
    return std::exp(std::uniform_real_distribution(std::log(least), std::log(most))(random));
  };
  const auto sometimes = [&](double value) { return random() % 2 == 0 ? value : 0.0; };
  Hub hub;
  hub.alone.name = "hub";
  hub.alone.bodies = {{"hub", log_uniform(0.05, 5.0), log_uniform(0.01, 5.0), sometimes(log_uniform(10.0, 1e4)), 0.0}};
  hub.branch.body = {"", log_uniform(0.02, 2.0), sometimes(log_uniform(3e-3, 1.0)), sometimes(log_uniform(10.0, 1e4)),
                     0.0};
  hub.branch.link = {0, 1, log_uniform(1e3, 1e6), sometimes(log_uniform(3e-3, 10.0))};
  hub.alone.loop.sampling_period = random() % 3 == 0 ? 2e-4 : 1e-3;
  hub.alone.loop.delay = random() % 3 == 0 ? 4.37 * hub.alone.loop.sampling_period : 0.0;
  hub.alone.actuator.time_constant = sometimes(log_uniform(1e-5, 2e-3));
  hub.alone.user.mass = sometimes(log_uniform(0.05, 1.0));
  if (random() % 3 == 0) {
    hub.alone.wall.damping = log_uniform(0.1, 10.0);
    hub.alone.wall.velocity_filter_hz = sometimes(50.0);
  }
  return hub;
}

TEST(AlikeBranches, SixAreOneOfSixTimes) {
  for (unsigned seed = 0; seed < test::by_tier(10U, 40U); ++seed) {
    const Hub hub = random_hub(seed);
    const CriticalStiffness six = critical_stiffness(Device(with_branches(hub.alone, hub.branch, 6)));
    const CriticalStiffness one = critical_stiffness(Device(with_branches(hub.alone, times(hub.branch, 6.0), 1)));
    EXPECT_TRUE(six.trust.sound()) << "seed " << seed;
    ASSERT_EQ(six.status, one.status) << "seed " << seed;
    EXPECT_NEAR(six.stiffness, one.stiffness, 1e-9 * one.stiffness) << "seed " << seed;
    ASSERT_EQ(six.crossovers.size(), one.crossovers.size()) << "seed " << seed;
    for (std::size_t i = 0; i < one.crossovers.size(); ++i) {
      EXPECT_NEAR(six.crossovers[i].stiffness, one.crossovers[i].stiffness, 1e-8 * one.crossovers[i].stiffness)
          << "seed " << seed;
    }
  }
}

// Springs and masses apart by 1e-2 down to 1e-12: five modes that the hub hardly sees. Refused: "cancel beyond 30 digits".
TEST(AlikeBranches, NearlyAlikeOnesAreAnswered) {
  for (unsigned seed = 0; seed < test::by_tier(6U, 24U); ++seed) {
    const Hub hub = random_hub(seed);
    DeviceParameters parameters = with_branches(hub.alone, hub.branch, 6);
    std::mt19937_64 random(seed);
    const double spread = std::pow(10.0, -2.0 - 2.0 * static_cast<double>(seed % 6));
    for (Link& link : parameters.links)
      link.stiffness *= 1.0 + spread * std::uniform_real_distribution(-1.0, 1.0)(random);
    parameters.bodies[3].mass *= 1.0 + spread;
    const Device device(parameters);
    const CriticalStiffness result = critical_stiffness(device);
    EXPECT_TRUE(result.trust.sound()) << "seed " << seed;
    if (result.status != StiffnessStatus::finite) continue;
    const test::ExactClosedLoop loop(device);
    EXPECT_EQ(loop.poles_outside((1.0 - 1e-9) * result.stiffness), 0) << "seed " << seed;
    EXPECT_GT(loop.poles_outside((1.0 + 1e-9) * result.stiffness), 0) << "seed " << seed;
  }
}

}  // namespace
}  // namespace zwidth
