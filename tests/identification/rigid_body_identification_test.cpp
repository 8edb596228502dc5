// Inverse dynamics, judged: a device that is not rigid, a reversed position, a clean rigid body.
#include "zwidth/identification/rigid_body_identification.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>

#include "identification/synthetic_response.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using ::testing::HasSubstr;

/// A body of 1 kg in all, the handle on a link whose mode lies at `mode_hz`; 0: rigid.
Device body_of_one_kilogram(double mode_hz) {
  DeviceParameters device;
  device.bodies = {{"motor", 0.4, 2.0, 0.0, 0.0}, {"handle", 0.6, 2.0, 0.0, 0.0}};
  const double angular = 2.0 * std::numbers::pi * mode_hz;
  const double reduced = 0.4 * 0.6;
  device.links = {{0, 1, angular * angular * reduced, 2.0 * 0.02 * angular * reduced}};
  if (mode_hz == 0.0) {
    device.bodies = {{"body", 1.0, 4.0, 0.0, 0.0}};
    device.links.clear();
  }
  device.loop = {0, 0, device.bodies.size() - 1, 1e-3, 0.0};
  return Device(device);
}

Recording recorded(const Device& device, double highest_hz, std::uint64_t seed) {
  ExcitationOptions excitation;
  excitation.kind = ExcitationKind::noise;
  excitation.amplitude = 10.0;
  excitation.lowest_hz = 0.5;
  excitation.highest_hz = highest_hz;
  excitation.seed = seed;
  const std::vector<double> force = excite(excitation).samples;
  return {"simulated",
          device.loop().sampling_period,
          {{"force", force}, {"position", test::synthetic_position(device, force, {0.02, 1e-6, seed})}},
          {}};
}

// The cutoff sat on the mode or above it: 8 to 15 % off, beyond the interval.
TEST(RigidBodyIdentification, AModeBiasesTheInertiaByAFewPerCentAndIsSaid) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const RigidBodyIdentification found = identify_rigid_body(recorded(body_of_one_kilogram(40.0), 80.0, seed));
    EXPECT_NEAR(found.fit.mass.value, 1.0, 0.05) << "seed " << seed;
    EXPECT_LT(found.fit.cutoff_hz, 10.0) << "seed " << seed;
    EXPECT_EQ(found.trust.verdict, Trust::Verdict::doubtful) << "seed " << seed;
    ASSERT_TRUE(found.device.parameters().uncertainty) << "seed " << seed;
    EXPECT_THAT(found.device.parameters().uncertainty->warning, HasSubstr("not rigid")) << "seed " << seed;
  }
}

TEST(RigidBodyIdentification, ARigidBodyIsSound) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const RigidBodyIdentification found = identify_rigid_body(recorded(body_of_one_kilogram(0.0), 20.0, seed));
    EXPECT_TRUE(found.trust.sound()) << "seed " << seed << (found.trust.sound() ? "" : found.trust.reasons.front());
    EXPECT_NEAR(found.fit.mass.value, 1.0, 0.01) << "seed " << seed;
  }
}

TEST(RigidBodyIdentification, AReversedPositionIsRefused) {
  Recording recording = recorded(body_of_one_kilogram(0.0), 20.0, 1);
  for (double& value : recording.channels[1].samples) value = -value;
  EXPECT_THROW((void)identify_rigid_body(recording), Error);
}

TEST(RigidBodyIdentification, NamesTheMemberOfAnImpossibleOption) {
  RigidBodyOptions options;
  EXPECT_FALSE(find_problem(options));
  options.sampling_period = 0.0;
  EXPECT_EQ(find_problem(options)->member, "sampling_period");
  options = {};
  options.inverse_dynamics.cutoff_hz = -1.0;
  EXPECT_EQ(find_problem(options)->member, "inverse_dynamics.cutoff_hz");
}

}  // namespace
}  // namespace zwidth
