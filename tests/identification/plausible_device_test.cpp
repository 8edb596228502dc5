#include "identification/verdict/plausible_device.hpp"

#include <gtest/gtest.h>

namespace zwidth::internal {
namespace {

Device body_of(double mass, Motion motion) {
  DeviceParameters device;
  device.name = "body";
  device.motion = motion;
  device.bodies = {{"body", mass, 1.0, 0.0, 0.0}};
  device.loop.sampling_period = 1e-3;
  return Device(device);
}

// A force in mN taken for N: 300 kg, and 1000 times too high.
TEST(PlausibleDevice, NoHapticDeviceIsAsHeavyAsThat) {
  const auto heavy = doubt_of_masses(body_of(300.0, Motion::linear), body_of(300.0, Motion::linear), false);
  ASSERT_TRUE(heavy);
  EXPECT_EQ(heavy->code, FindingCode::fitted_body_too_heavy);
  EXPECT_EQ(heavy->evidence[0], (Evidence{"mass", 300.0}));
  EXPECT_EQ(heavy->evidence[1], (Evidence{"threshold", 100.0}));
  EXPECT_FALSE(doubt_of_masses(body_of(90.0, Motion::linear), body_of(90.0, Motion::linear), false));
  EXPECT_TRUE(doubt_of_masses(body_of(11.0, Motion::rotary), body_of(11.0, Motion::rotary), false));
  EXPECT_FALSE(doubt_of_masses(body_of(9.0, Motion::rotary), body_of(9.0, Motion::rotary), false));
}

TEST(PlausibleDevice, MassesFarFromAKnownStructureAreDoubtedOrWarnedOf) {
  const Device known = body_of(0.2, Motion::linear);
  const Device thousand = body_of(200.0, Motion::linear);
  const auto doubt = doubt_of_masses(thousand, known, true);
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->code, FindingCode::mass_far_from_structure);
  EXPECT_EQ(doubt->key, "body.body.mass");
  EXPECT_NEAR(doubt->evidence[0].value, 1000.0, 1e-9);
  EXPECT_TRUE(implausible_device(thousand, &known, 1e-3).empty());

  const Device ten = body_of(2.0, Motion::linear);
  EXPECT_FALSE(doubt_of_masses(ten, known, true));
  const auto warned = implausible_device(ten, &known, 1e-3);
  ASSERT_EQ(warned.size(), 1U);
  EXPECT_EQ(warned[0].finding.value().code, FindingCode::mass_far_from_structure);
  EXPECT_TRUE(implausible_device(body_of(0.3, Motion::linear), &known, 1e-3).empty());
}

// A wrong unit scales every mass: one body that is much too heavy is held.
TEST(PlausibleDevice, AHeldHandleIsNoDoubt) {
  DeviceParameters held = body_of(0.3, Motion::linear).parameters();
  held.bodies.push_back({"handle", 1e6, 1.0, 0.0, 0.0});
  held.links = {{0, 1, 8e4, 1.0}};
  DeviceParameters known = held;
  known.bodies[1].mass = 0.2;
  EXPECT_FALSE(doubt_of_masses(Device(held), Device(held), false));
  const Device structure(known);
  EXPECT_FALSE(doubt_of_masses(Device(held), structure, true));
  EXPECT_EQ(implausible_device(Device(held), &structure, 1e-3).size(), 1U);
}

TEST(PlausibleDevice, ABodyThatTheStructureLacksSparesNoMass) {
  DeviceParameters with_further = body_of(300.0, Motion::linear).parameters();
  with_further.bodies.push_back({"further", 50.0});
  with_further.links = {{0, 1, 8e4, 1.0}};
  EXPECT_TRUE(doubt_of_masses(Device(with_further), body_of(1.0, Motion::linear), false));
  EXPECT_TRUE(doubt_of_masses(Device(with_further), body_of(0.3, Motion::linear), true));
}

// Rows of 1 ms whose times are read as 1 s.
TEST(PlausibleDevice, APeriodFarFromTheRecordsIsWarnedOf) {
  const auto remarks = implausible_device(body_of(0.2, Motion::linear), nullptr, 1.0);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].finding.value().code, FindingCode::period_far_from_record);
  EXPECT_TRUE(implausible_device(body_of(0.2, Motion::linear), nullptr, 1e-3).empty());
}

}  // namespace
}  // namespace zwidth::internal
