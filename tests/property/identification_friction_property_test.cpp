// Simulated recordings, with dry friction and without, that identify() took for the other: seeds of
// benchmarks/identification_campaign.cpp.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <span>

#include "campaign.hpp"
#include "identification/friction_in_time.hpp"
#include "property/identified_recordings.hpp"
#include "property/random_recordings.hpp"
#include "zwidth/identification/identification.hpp"

namespace zwidth {
namespace {

using test::expect_doubtful;
using test::identified;

// Friction that no small disturbance of the linear fit's motion shows, since the device drifts until friction stops it, or
// has modes above the band: 39, 18, 7 and 53 % too high at the interval's lower end, called sound.
TEST(IdentificationProperty, FrictionThatTheLinearFitHidesIsFoundInTime) {
  constexpr std::array<std::uint64_t, 4> seeds{1000413, 910134, 1000307, 1000868};
  for (const std::uint64_t seed : std::span(seeds).first(test::by_tier(1U, 4U))) {
    const auto made = test::random_recording(seed);
    ASSERT_TRUE(made && made->has_friction);
    Identification found = identified(*made);
    expect_doubtful(found, *made);
    found.trust = {};  // of the last a mode above the band is doubted first
    internal::judge_friction_in_time(found, std::span(&made->recording, 1), {});
    EXPECT_FALSE(found.trust.sound()) << "seed " << seed;
    ASSERT_TRUE(found.friction) << "seed " << seed;
    double friction = 0.0;
    for (const Body& body : made->truth.bodies) friction += body.coulomb;
    // As near as it says; of the third the likelihood itself is greatest 14 % away, which is three of its deviations.
    const double near = seed == 1000307U ? 0.15 * friction : 2.0 * found.friction->deviation;
    EXPECT_NEAR(found.friction->force, friction, near) << "seed " << seed;
    EXPECT_LT(found.friction->deviation, 0.25 * friction) << "seed " << seed;
    ASSERT_TRUE(found.friction->stiffness_beside) << "seed " << seed;
    EXPECT_NEAR(*found.friction->stiffness_beside, made->stiffness, 0.02 * made->stiffness) << "seed " << seed;
  }
}

// Friction of the lighter body, of a device excited to 270 Hz: over all lines the residuals are 1.3 times the noise, from
// 32 to 43 Hz 2.7 times. Was sound, and 1.6 times too high at its lower end.
TEST(IdentificationProperty, FrictionThatAFewLinesShowIsNeverSound) {
  const auto made = test::random_recording(1300194);
  ASSERT_TRUE(made && made->has_friction);
  Identification found = identified(*made);
  expect_doubtful(found, *made);
  ASSERT_FALSE(found.trust.reasons.empty());
  EXPECT_TRUE(found.trust.reasons.front().starts_with("from 32.23 to 43.46 Hz")) << found.trust.reasons.front();
  // The fit in time looks at the lighter body too.
  found.trust = {};
  internal::judge_friction_in_time(found, std::span(&made->recording, 1), {});
  EXPECT_FALSE(found.trust.sound());
  ASSERT_TRUE(found.friction);
  EXPECT_EQ(found.friction->body, "body1");
  EXPECT_NEAR(found.friction->force, made->truth.bodies[1].coulomb, 2.0 * found.friction->deviation);
  EXPECT_NEAR(*found.friction->stiffness_beside, made->stiffness, 0.1 * made->stiffness);
}

}  // namespace
}  // namespace zwidth
