// Simulated devices with dry friction, moved by a route that shares nothing with the library's. The whole campaign is
// benchmarks/friction_campaign.cpp.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "property/friction_recordings.hpp"
#include "zwidth/identification/time_domain.hpp"

namespace zwidth {
namespace {

TEST(TimeDomainProperty, FrictionDoesNotMoveTheCriticalStiffness) {
  int held = 0;
  int answered = 0;
  constexpr std::array<std::uint64_t, 3> seeds{12, 13, 16};
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

}  // namespace
}  // namespace zwidth
