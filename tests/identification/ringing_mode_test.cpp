// A device on a spring that rings on from one segment of the record to the next: 7 of 7 intervals lay up to 1.7 % above the
// truth, 5 of them sound.
#include "identification/ringing_mode.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "campaign.hpp"
#include "identification/synthetic_response.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

DeviceParameters on_a_hand() {
  DeviceParameters device;
  device.name = "on a hand";
  device.bodies = {{"motor", 0.248, 1.41, 0.0, 0.0}, {"handle", 0.581, 0.078, 0.0, 0.0}};
  device.links = {{0, 1, 117.8e3, 3.62}};
  device.loop = {0, 0, 1, 1e-3, 1.63e-3};
  device.user = {0.184, 0.752, 607.2};
  return device;
}

Recording swept(const DeviceParameters& device, double duration, std::uint64_t seed) {
  ExcitationOptions sweep;
  sweep.kind = ExcitationKind::linear_chirp;
  sweep.amplitude = 4.0;
  sweep.lowest_hz = 1.0;
  sweep.highest_hz = 200.0;
  sweep.duration = duration;
  std::vector<double> force = excite(sweep).samples;
  std::vector<double> position = test::synthetic_position(Device(device), force, {0.0, 1e-5, seed});
  return {"", 1e-3, {{"force", std::move(force)}, {"position", std::move(position)}}, {}};
}

TEST(RingingMode, DiesOutOverLongerSegments) {
  const DeviceParameters device = on_a_hand();
  const double truth = critical_stiffness(Device(device)).stiffness;
  IdentifyOptions options;
  options.scrutiny = IdentifyOptions::Scrutiny::brief;
  for (std::uint64_t seed = 1; seed <= test::by_tier(1U, 5U); ++seed) {
    const Identification found = identify(swept(device, 16.0, seed), Device(device), options);
    ASSERT_TRUE(found.analysis.interval) << "seed " << seed;
    EXPECT_LE(found.analysis.interval->lower, truth) << "seed " << seed;
    EXPECT_NEAR(found.analysis.critical.stiffness, truth, 0.03 * truth) << "seed " << seed;
  }
}

TEST(RingingMode, OfARecordTooShortForItIsDoubtful) {
  DeviceParameters device = on_a_hand();
  IdentifyOptions options;
  options.scrutiny = IdentifyOptions::Scrutiny::brief;
  Identification found = identify(swept(device, 16.0, 1), Device(device), options);
  const Recording recording = swept(device, 16.0, 1);
  ASSERT_TRUE(found.trust.sound());
  EXPECT_FALSE(internal::doubt_of_ringing(found, std::span(&recording, 1), options));
  device.bodies[0].damping = 0.1;  // rings for seconds
  device.bodies[1].damping = 0.0;
  device.user.damping = 0.2;
  const Recording ringing = swept(device, 8.0, 1);
  found = identify(ringing, Device(device), options);
  EXPECT_FALSE(found.trust.sound());
  const auto doubt = internal::doubt_of_ringing(found, std::span(&ringing, 1), options);
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->code, FindingCode::segments_truncate_mode);
}

}  // namespace
}  // namespace zwidth
