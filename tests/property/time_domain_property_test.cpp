// Simulated devices with dry friction, moved by a route that shares nothing with the library's. The whole campaign is
// benchmarks/friction_campaign.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "property/friction_recordings.hpp"
#include "zwidth/identification/time_domain.hpp"

namespace zwidth {
namespace {

TEST(TimeDomainProperty, FrictionDoesNotMoveTheCriticalStiffness) {
  int held = 0;
  int answered = 0;
  constexpr std::uint64_t first = 12;
  constexpr std::uint64_t count = 6;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
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
  EXPECT_EQ(answered, static_cast<int>(count));
  // Of six 95 % intervals two miss with a chance of 3 %.
  EXPECT_GE(held, answered - 2);
}

}  // namespace
}  // namespace zwidth
