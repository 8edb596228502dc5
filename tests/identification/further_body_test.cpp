#include "identification/further_body.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "identification/campaign/bench.hpp"
#include "identification/campaign/judge.hpp"
#include "identification/campaign/kinds.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/model/device_trust.hpp"

namespace zwidth::internal {
namespace {

DeviceParameters motor_and_handle() {
  DeviceParameters device;
  device.bodies = {{"motor", 0.2, 0.1}, {"further", 0.1, 0.1}};
  device.links = {{0, 1, 1e3, 0.1}};
  device.loop = {.actuated = 0, .sensed = 0, .held = 1, .sampling_period = 1e-3};
  return device;
}

FrequencyResponse band() {
  FrequencyResponse response;
  response.points = {{.frequency = 10.0, .value = 1.0}, {.frequency = 1000.0, .value = 1.0}};
  return response;
}

TEST(FurtherBody, StandsBehindTheHeldOneUnderANameOfItsOwn) {
  const auto further = with_further_body(Device(motor_and_handle()), {}, band());
  ASSERT_TRUE(further);
  const DeviceParameters& device = further->structure.parameters();
  ASSERT_EQ(device.bodies.size(), 3U);
  EXPECT_EQ(device.bodies[2].name, "further_body");
  EXPECT_EQ(device.links.back().first, 1U);
  EXPECT_EQ(device.links.back().second, 2U);
  EXPECT_EQ(device.loop.held, 1U);
  EXPECT_TRUE(further->free.keys.empty());  // all
}

TEST(FurtherBody, IsFreeBesideWhatIsNamed) {
  const auto further = with_further_body(Device(motor_and_handle()), {.keys = {"link.stiffness"}}, band());
  ASSERT_TRUE(further);
  EXPECT_EQ(further->free.keys,
            (std::vector<std::string>{"link.0.stiffness", "body.further_body.mass", "body.further_body.damping",
                                      "link.1.stiffness", "link.1.damping"}));
}

TEST(FurtherBody, IsNoneWhereTheHeldBodyStandsStillOrIsHeldOrNoneMoreCanBePlayed) {
  EXPECT_FALSE(with_further_body(Device(motor_and_handle()), {.locked = {"further"}}, band()));
  DeviceParameters held = motor_and_handle();
  held.user.damping = 1.0;
  EXPECT_FALSE(with_further_body(Device(held), {}, band()));
  DeviceParameters many = motor_and_handle();
  while (many.bodies.size() < 20) {
    many.links.push_back({many.bodies.size() - 1, many.bodies.size(), 1e3, 0.1});
    many.bodies.push_back({"body" + std::to_string(many.bodies.size()), 0.1, 0.1});
  }
  EXPECT_FALSE(with_further_body(Device(many), {}, band()));
}

/// One that creeps, or swings where no force is, stands for anything.
TEST(FurtherBody, IsAModeWhereItSwingsWithinTheBand) {
  DeviceParameters device = motor_and_handle();  // 122 rad/s
  EXPECT_TRUE(is_mode(device, band()));
  device.links[0].damping = 10.0;
  EXPECT_FALSE(is_mode(device, band()));
  device.links[0] = {0, 1, 1e5, 0.1};
  EXPECT_FALSE(is_mode(device, band()));
}

/// A body of 0.049 kg at 15.7 Hz, which the structure does not name.
TEST(FurtherBody, OfTheMotionIsFittedNotedAndDoubtedInTheFile) {
  using namespace test::campaign;
  const Case made = drawn_case(*find_kind("mode_in_band"), 703);
  std::vector<Recording> recordings;
  for (const Rows& each : recorded(made, 0)) recordings.push_back(test::campaign::detail::read_back(each));
  IdentifyOptions how;
  how.structure_values = IdentifyOptions::StructureValues::placeholders;
  const Identification found = identify(recordings, Device(made.structure), how);
  EXPECT_TRUE(found.trust.sound());
  ASSERT_TRUE(found.analysis.interval);
  EXPECT_LT(found.analysis.interval->lower, made.stiffness);
  EXPECT_GT(found.analysis.interval->upper, made.stiffness);
  const Finding* noted = nullptr;
  for (const Remark& each : found.remarks) {
    if (each.finding && each.finding->code == FindingCode::further_body_fitted) noted = &*each.finding;
  }
  ASSERT_NE(noted, nullptr);
  const test::simulated::Mass& body = made.plant.masses[1];
  EXPECT_EQ(noted->evidence[0].name, "mass");
  EXPECT_NEAR(noted->evidence[0].value, body.mass, 0.05 * body.mass);
  EXPECT_EQ(noted->evidence[1].name, "frequency");
  EXPECT_NEAR(noted->evidence[1].value, made.mode_hz, 0.02 * made.mode_hz);
  EXPECT_EQ(found.fit.device.bodies().size(), 2U);
  EXPECT_EQ(trust_of(found.fit.device).verdict, Trust::Verdict::doubtful);
}

}  // namespace
}  // namespace zwidth::internal
