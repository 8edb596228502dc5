// design --compare on random devices, against closed loops of each design in 200 digits that share nothing with the library
// (exact_closed_loop.hpp): every limit, and which design is the best.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "exact_closed_loop.hpp"
#include "property/random_devices.hpp"
#include "zwidth/design/design_comparison.hpp"
#include "zwidth/stability/worst_user.hpp"

namespace zwidth::test {
namespace {

constexpr std::uint64_t first_seed = 20261125;
constexpr std::array compared_kinds = {
    "rigid",        "two_mass", "user_side",      "three_mass",    "fractional_delay", "rotary",  "chain",
    "actuator_lag", "grounded", "virtual_damper", "light_damping", "slow_sampling",    "operator"};
constexpr double close_to_limit = 1e-5;  // relative; the limits themselves are known better
constexpr int users_tried = 4;
constexpr std::size_t usual_cases = 13;
constexpr std::size_t few_absorbers = 2;
constexpr double just_above = 1.0001;  // where worst_user() has its own proof

// ZWIDTH_CAMPAIGN_DEVICES=300 tries more.
std::size_t devices_compared() {
  if (const char* campaign = std::getenv("ZWIDTH_CAMPAIGN_DEVICES")) return std::strtoul(campaign, nullptr, 10);
  const char* asked = std::getenv("ZWIDTH_PROPERTY_CASES");
  return asked ? std::clamp<std::size_t>(std::strtoul(asked, nullptr, 10), 1, usual_cases) : usual_cases;
}

// The design as its own device: what a variant changes is set here again.
DeviceParameters alone(const DeviceParameters& device, const std::string& key, std::size_t index, const User& user) {
  DeviceParameters parameters = device;
  if (key == "loop.sensed") parameters.loop.sensed = index;
  if (key == "loop.delay") parameters.loop.delay += 0.6 * static_cast<double>(index) * parameters.loop.sampling_period;
  parameters.user = user;
  return parameters;
}

void expect_limit(const DeviceParameters& parameters, const CriticalStiffness& critical) {
  ASSERT_FALSE(critical.trust.refused());
  const ExactClosedLoop loop{Device(parameters)};
  if (critical.status == StiffnessStatus::none_stable) {
    // From arbitrarily soft walls on: below every crossover.
    double softest = 1e-3;
    for (const Crossover& each : critical.crossovers) softest = std::min(softest, 0.5 * each.stiffness);
    EXPECT_GT(loop.poles_outside(softest), 0);
    return;
  }
  ASSERT_EQ(critical.status, StiffnessStatus::finite);
  for (const double share : {0.01, 0.3, 0.7, 1.0 - close_to_limit}) {
    EXPECT_EQ(loop.poles_outside(share * critical.stiffness), 0) << share;
  }
  EXPECT_GT(loop.poles_outside((1.0 + close_to_limit) * critical.stiffness), 0);
}

// No user tried destabilises below; the worst one does above.
void expect_absolute_stability_limit(const DeviceParameters& parameters, const AbsoluteStabilityLimit& limit,
                                     RandomDevices& random) {
  const double below = (1.0 - close_to_limit) * limit.stiffness;
  if (below > 0.0) {
    EXPECT_EQ(ExactClosedLoop{Device(parameters)}.poles_outside(below), 0);
    for (int i = 0; i < users_tried; ++i) {
      DeviceParameters held = parameters;
      const double scale = parameters.motion == Motion::rotary ? 1e-4 : 1.0;
      held.user = {scale * random.log_uniform(0.01, 10.0),
                   random.chance(0.5) ? 0.0 : scale * random.log_uniform(0.1, 30.0),
                   scale * random.log_uniform(10.0, 1e5)};
      EXPECT_EQ(ExactClosedLoop{Device(held)}.poles_outside(below), 0);
    }
  }
  const Device device(parameters);
  const auto worst = worst_user(device, limit, virtual_damper(device));
  if (!worst || worst->user.absorbers.size() > few_absorbers) return;
  EXPECT_GT(ExactClosedLoop{held_by(device, worst->user)}.poles_outside(just_above * worst->critical_stiffness), 0);
}

// At a stiffness between the two the best is stable and the second is not.
void expect_best(const std::vector<DeviceParameters>& designs, const BestDesigns& best, double of_best,
                 double of_second) {
  EXPECT_GE(of_best, of_second);
  if (best.as_good) return;
  const double between = 0.5 * (of_best + of_second);
  EXPECT_EQ(ExactClosedLoop{Device(designs[best.best])}.poles_outside(between), 0);
  EXPECT_GT(ExactClosedLoop{Device(designs[best.second])}.poles_outside((1.0 + close_to_limit) * of_second), 0);
}

TEST(DesignComparisonProperty, EveryLimitIsThatOfTheDesignAlone) {
  std::size_t limits = 0;
  for (std::size_t i = 0; i < devices_compared(); ++i) {
    const std::string_view kind = compared_kinds[i % compared_kinds.size()];
    SCOPED_TRACE(testing::Message() << kind << ", seed " << first_seed + i);
    RandomDevices random(first_seed + i);
    DeviceParameters device = random.device(kind);
    device.user = {};
    const bool by_delay = device.bodies.size() == 1 || random.chance(0.4);
    const std::string key = by_delay ? "loop.delay" : "loop.sensed";
    const std::size_t count = by_delay ? 3 : device.bodies.size();
    const double scale = device.motion == Motion::rotary ? 1e-4 : 1.0;
    const User user = {scale * random.log_uniform(0.05, 0.8), scale * random.log_uniform(1.0, 30.0),
                       scale * random.log_uniform(20.0, 1000.0)};
    DeviceVariants variants{key, {}};
    std::vector<DeviceParameters> free;
    for (std::size_t k = 0; k < count; ++k) {
      free.push_back(alone(device, key, k, {}));
      variants.variants.push_back({std::to_string(k), Device(free.back())});
    }
    const DesignComparison comparison = compare_designs(variants, user);
    ASSERT_EQ(comparison.designs.size(), count);
    for (std::size_t k = 0; k < count; ++k) {
      SCOPED_TRACE(testing::Message() << key << ' ' << k);
      const ComparedDesign& design = comparison.designs[k];
      expect_limit(free[k], design.free);
      ASSERT_TRUE(design.held);
      expect_limit(alone(device, key, k, user), *design.held);
      ASSERT_TRUE(design.any_user);
      expect_absolute_stability_limit(free[k], *design.any_user, random);
      limits += 3;
    }
    const auto& designs = comparison.designs;
    if (const auto& best = comparison.best_free) {
      expect_best(free, *best, designs[best->best].free.stiffness, designs[best->second].free.stiffness);
    }
    if (const auto& best = comparison.best_any_user) {
      EXPECT_GE(designs[best->best].any_user->stiffness, designs[best->second].any_user->stiffness);
    }
    for (const auto& best : {comparison.best_free, comparison.best_held, comparison.best_any_user}) {
      ASSERT_TRUE(best);
      EXPECT_NE(best->best, best->second);
    }
    // No third design beats the second.
    for (const ComparedDesign& each : designs) {
      EXPECT_LE(each.free.stiffness, designs[comparison.best_free->best].free.stiffness);
      EXPECT_LE(each.held->stiffness, designs[comparison.best_held->best].held->stiffness);
      EXPECT_LE(each.any_user->stiffness, designs[comparison.best_any_user->best].any_user->stiffness);
    }
  }
  EXPECT_GE(limits, 3 * devices_compared());
}

}  // namespace
}  // namespace zwidth::test
