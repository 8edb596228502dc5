// 40 devices whose spring and damper run at two rates, computed elsewhere by eigenvalues of the exact loop.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

constexpr double relative_tolerance = 1e-9;

DeviceParameters parameters_of(const nlohmann::json& json) {
  DeviceParameters parameters;
  parameters.name = json.at("name");
  for (const auto& body : json.at("bodies")) {
    parameters.bodies.push_back({"body " + std::to_string(parameters.bodies.size()), body[0], body[1], 0.0, 0.0});
  }
  for (const auto& link : json.at("links")) parameters.links.push_back({link[0], link[1], link[2], link[3]});
  const auto& spring = json.at("spring");
  parameters.loop.held = parameters.bodies.size() - 1;
  parameters.loop.sampling_period = spring.at("sampling_period");
  parameters.loop.delay = spring.at("delay");
  const auto& damper = json.at("damper");
  parameters.loop.damper = LoopDamper{damper.at("sampling_period").get<double>(), damper.at("delay").get<double>()};
  parameters.wall.damping = damper.at("damping");
  parameters.wall.velocity_filter_hz = damper.at("velocity_filter_hz");
  return parameters;
}

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
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/two_rates.json");
  const nlohmann::json cases = nlohmann::json::parse(file);
  ASSERT_EQ(cases.size(), 40U);
  for (const auto& each : cases) {
    DeviceParameters parameters = parameters_of(each);
    SCOPED_TRACE(parameters.name);
    expect_limit(critical_stiffness(Device(parameters)), each.at("critical_stiffness"));
    parameters.wall.damping = 0.0;
    expect_limit(critical_stiffness(Device(parameters)), each.at("critical_stiffness_without_damper"));
  }
}

}  // namespace
}  // namespace zwidth
