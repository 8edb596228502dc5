#include "identification/response/plausibility.hpp"

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

// A force in mN taken for N: 300 kg, sound, and 1000 times too high.
TEST(Plausibility, NoHapticDeviceIsAsHeavyAsThat) {
  const auto heavy = doubt_of_weight(body_of(300.0, Motion::linear));
  ASSERT_TRUE(heavy);
  EXPECT_EQ(heavy->code, FindingCode::fitted_body_too_heavy);
  EXPECT_EQ(heavy->evidence[0], (Evidence{"mass", 300.0}));
  EXPECT_EQ(heavy->evidence[1], (Evidence{"threshold", 100.0}));
  EXPECT_FALSE(doubt_of_weight(body_of(90.0, Motion::linear)));
  EXPECT_TRUE(doubt_of_weight(body_of(11.0, Motion::rotary)));
  EXPECT_FALSE(doubt_of_weight(body_of(9.0, Motion::rotary)));
}

}  // namespace
}  // namespace zwidth::internal
