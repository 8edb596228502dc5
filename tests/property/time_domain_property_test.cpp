// Simulated devices with dry friction, moved by a route that shares nothing with the library's. The whole campaign is
// benchmarks/friction_campaign.cpp.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <string>

#include "campaign.hpp"
#include "property/friction_recordings.hpp"
#include "property/random_recordings.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/time_domain.hpp"

namespace zwidth {
namespace {

TEST(TimeDomainProperty, FrictionDoesNotMoveTheCriticalStiffness) {
  int held = 0;
  int answered = 0;
  constexpr std::array<std::uint64_t, 3> all{12, 13, 16};
  const std::span seeds = std::span(all).first(test::by_tier(1U, 3U));
  for (const std::uint64_t seed : seeds) {
    const test::FrictionRecordings made = test::friction_recordings(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + made.what);
    TimeDomainOptions options;
    options.structure_values = IdentifyOptions::StructureValues::placeholders;
    const TimeDomainIdentification found = identify_in_time(made.recordings, Device(made.structure), options);
    if (found.trust.refused()) continue;
    ++answered;
    EXPECT_NEAR(found.analysis.critical.stiffness, made.stiffness, 0.05 * made.stiffness);
    ASSERT_TRUE(found.analysis.interval);
    if (found.analysis.interval->lower <= made.stiffness && made.stiffness <= found.analysis.interval->upper) ++held;
    for (std::size_t i = 0; i < made.truth.bodies.size(); ++i) {
      EXPECT_NEAR(found.device.bodies()[i].coulomb, made.truth.bodies[i].coulomb,
                  0.02 * made.friction_share * test::detail::largest(made.recordings[0].channels[0].samples));
    }
  }
  EXPECT_EQ(answered, static_cast<int>(seeds.size()));
  EXPECT_GE(held, answered - 1);
}

// As the instants of sticking and slipping change, the misfit has kinks, and side minima between them. A search that ended
// at one came to 12.3 % too high. What is left is the disturbance: without it this device comes out right, with
// twelve others of the same size between 8.4 % too low and 9 % too high. The sums over its own residuals promise 2.6 % (one
// deviation), and an interval that begins 4.2 % above the truth.
TEST(TimeDomainProperty, ASearchPassesTheKinksOfItsMisfit) {
  const test::FrictionRecordings made = test::friction_recordings(900007);
  TimeDomainOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  const TimeDomainIdentification found = identify_in_time(made.recordings, Device(made.structure), options);
  ASSERT_TRUE(found.analysis.interval) << "seed 900007: " << made.what;
  EXPECT_NEAR(found.analysis.critical.stiffness, made.stiffness, 0.11 * made.stiffness);
  EXPECT_LE(found.analysis.interval->lower, made.stiffness);
  EXPECT_GE(found.analysis.interval->upper, made.stiffness);
  EXPECT_LE(found.analysis.interval->upper, 1.25 * made.stiffness);
}

// Two bodies that move as one in the band: the linear fit joins them by a damper of 1700 N s/m, which cannot be played. Ended
// in an error. (1700046 and 1700123 were refused.)
TEST(TimeDomainProperty, ALinkThatOnlyDampsIsNoStart) {
  const test::FrictionRecordings made = test::friction_recordings(1700076);
  TimeDomainOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  const TimeDomainIdentification found = identify_in_time(made.recordings, Device(made.structure), options);
  EXPECT_TRUE(found.trust.sound());
  EXPECT_NEAR(found.analysis.critical.stiffness, made.stiffness, 0.01 * made.stiffness);
  ASSERT_TRUE(found.analysis.interval);
  EXPECT_LE(found.analysis.interval->lower, made.stiffness);
  EXPECT_GE(found.analysis.interval->upper, made.stiffness);
}

// Driven at one body and sensed at the other: a linear fit does not tell how the masses are divided between them (10:1, the
// device's are 1:3.4), and from there a search ended without friction. Was sound in the lines, its interval 41 % above the
// truth, and 58 % too high in time.
TEST(TimeDomainProperty, FrictionTellsHowTheMassesAreDivided) {
  constexpr std::array<std::uint64_t, 2> seeds{2400612, 2400218};
  for (const std::uint64_t seed : std::span(seeds).first(test::by_tier(1U, 2U))) {
    const auto made = test::random_recording(seed);
    ASSERT_TRUE(made && made->has_friction);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + made->what);
    TimeDomainOptions options;
    options.structure_values = IdentifyOptions::StructureValues::placeholders;
    const TimeDomainIdentification found =
        identify_in_time(std::span(&made->recording, 1), Device(made->structure), options);
    EXPECT_NEAR(found.analysis.critical.stiffness, made->stiffness, 0.05 * made->stiffness);
    ASSERT_TRUE(found.analysis.interval);
    EXPECT_LE(found.analysis.interval->lower, made->stiffness);
    EXPECT_GE(found.analysis.interval->upper, made->stiffness);
    EXPECT_NEAR(found.device.bodies()[0].mass, made->truth.bodies[0].mass, 0.05 * made->truth.bodies[0].mass);
    EXPECT_NEAR(found.device.bodies()[0].coulomb, made->truth.bodies[0].coulomb, 0.05 * made->truth.bodies[0].coulomb);
  }
}

TEST(TimeDomainProperty, FrictionOfADeviceWhoseMassesAreNotKnownIsNeverSound) {
  const auto made = test::random_recording(2400612);
  ASSERT_TRUE(made && made->has_friction);
  IdentifyOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  const Identification found = identify(made->recording, Device(made->structure), options);
  EXPECT_FALSE(found.trust.sound());
  ASSERT_TRUE(found.friction);
  EXPECT_NEAR(found.friction->force, made->truth.bodies[0].coulomb, 0.1 * made->truth.bodies[0].coulomb);
  EXPECT_NEAR(*found.friction->stiffness_beside, made->stiffness, 0.05 * made->stiffness);
}

}  // namespace
}  // namespace zwidth
