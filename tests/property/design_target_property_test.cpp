// design --target on random devices: each value needed, put into the device, is confirmed by analyze().

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "property/random_devices.hpp"
#include "zwidth/design/design_target.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::test {
namespace {

constexpr std::uint64_t seed = 20261123;
constexpr double closeness = 1e-9;

// ZWIDTH_CAMPAIGN_DEVICES=300 is the campaign: some minutes.
std::size_t cases(std::size_t usual) {
  if (const char* campaign = std::getenv("ZWIDTH_CAMPAIGN_DEVICES")) return std::strtoul(campaign, nullptr, 10);
  const char* asked = std::getenv("ZWIDTH_PROPERTY_CASES");
  return asked ? std::clamp<std::size_t>(std::strtoul(asked, nullptr, 10), 1, usual) : usual;
}

double analyzed_limit(const Device& device, StiffnessGoal goal) {
  const bool any_user = goal == StiffnessGoal::absolute_stability_limit;
  const Analysis analysis = analyze(device, {.any_user = any_user, .draws = 0});
  if (analysis.critical.trust.refused()) return std::nan("");
  return any_user ? std::min(analysis.critical.stiffness, analysis.any_user->stiffness) : analysis.critical.stiffness;
}

Device with(const Device& device, const std::string& key, double value) {
  DeviceParameters parameters = device.parameters();
  set_parameter(parameters, key, value);
  return Device(std::move(parameters));
}

struct Count {
  std::size_t confirmed = 0;
  std::size_t jumps = 0;
  std::size_t refused = 0;
};

void confirm(const Device& device, const DesignTargetOptions& options, Count& count) {
  for (const DesignTarget& each : design_targets(device, options).targets) {
    if (!each.value_needed) continue;
    SCOPED_TRACE(each.key + " " + std::to_string(*each.value_needed) + ": " + text(each.why));
    const auto limit_at = [&](double share) {
      return analyzed_limit(with(device, each.key, share * *each.value_needed), options.goal);
    };
    const double there = limit_at(1.0);
    if (each.why.code == FindingCode::limit_refused_at_value) {
      EXPECT_TRUE(std::isnan(there));
      ++count.refused;
    } else if (each.why.code == FindingCode::limit_jumps_across_target) {
      EXPECT_GE(there, options.stiffness);
      EXPECT_NE(limit_at(1.0 - 1e-7) >= options.stiffness, limit_at(1.0 + 1e-7) >= options.stiffness);
      ++count.jumps;
    } else {
      EXPECT_NEAR(there / options.stiffness, 1.0, closeness);
      ++count.confirmed;
    }
  }
}

void confirm_random(StiffnessGoal goal, std::size_t devices) {
  Count count;
  for (std::size_t i = 0; i < devices; ++i) {
    const std::string_view kind = device_kinds[i % device_kinds.size()];
    SCOPED_TRACE(testing::Message() << kind << ", seed " << seed + i);
    RandomDevices random(seed + i);
    const Device device(random.device(kind));
    const double share = random.log_uniform(0.3, 3.0);
    if (goal == StiffnessGoal::absolute_stability_limit && !device.has_bodies()) continue;
    const double now = analyzed_limit(device, goal);
    if (!(now > 0.0) || !std::isfinite(now)) continue;
    confirm(device, {.stiffness = share * now, .goal = goal}, count);
  }
  EXPECT_GE(count.confirmed, devices / 2);
  EXPECT_LT(count.refused, 1 + count.confirmed / 100);
  std::printf("%zu values confirmed, %zu at a jump, %zu refused\n", count.confirmed, count.jumps, count.refused);
}

TEST(DesignTargetProperty, AnalyzeConfirmsEveryValueNeeded) {
  confirm_random(StiffnessGoal::critical_stiffness, cases(84));
}

TEST(DesignTargetProperty, AnalyzeConfirmsEveryValueNeededWithAnyUser) {
  confirm_random(StiffnessGoal::absolute_stability_limit, cases(10));
}

// Hardly damped and sampled fast: its discs are thin, and p A hardly above q² on whole intervals.
TEST(DesignTargetProperty, ThinDiscsHaveATarget) {
  RandomDevices random(seed + 260);
  const Device device(random.device("fast_sampling"));
  const double wanted = 1.5 * absolute_stability_limit(device, virtual_damper(device)).stiffness;
  const DesignTargets targets =
      design_targets(device, {.stiffness = wanted, .goal = StiffnessGoal::absolute_stability_limit});
  EXPECT_TRUE(targets.targets.front().value_needed);
}

}  // namespace
}  // namespace zwidth::test
