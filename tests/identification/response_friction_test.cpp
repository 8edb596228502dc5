// Dry friction beside a measured response: simulated rigid bodies that rub, and the same without.
#include "identification/response_friction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "identification/friction_body.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/identification/measured_response.hpp"

namespace zwidth {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// 10 s at 1 kHz of 1.2 kg, 2 N s/m under noise, a sweep or a multisine.
Recording rubbed(double coulomb, ExcitationKind kind, std::uint64_t seed, double amplitude = 8.0) {
  ExcitationOptions excitation;
  excitation.kind = kind;
  excitation.amplitude = amplitude;
  excitation.duration = 10.0;
  excitation.rate = 1e3;
  excitation.lowest_hz = 0.5;
  excitation.highest_hz = 200.0;
  excitation.seed = seed;
  Recording recording{"run", 1e-3, {{"force", excite(excitation).samples}, {"position", {}}}, {}};
  test::FrictionBody body{.mass = 1.2, .viscous = 2.0, .coulomb = coulomb};
  for (const double force : recording.channels[0].samples) {
    recording.channels[1].samples.push_back(body.position);
    body.move(force, 1e-3);
  }
  return recording;
}

const auto says_friction = Contains(HasSubstr("dry friction, which the response takes for damping"));

TEST(ResponseFriction, MakesTheMeasuredStiffnessDoubtful) {
  int told = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const MeasuredResponse found = frequency_response(rubbed(0.3, ExcitationKind::noise, seed));
    EXPECT_FALSE(found.trust.sound()) << seed;
    if (found.stiffness->status != MeasuredStiffnessStatus::found) continue;  // refused
    EXPECT_THAT(found.trust.reasons, says_friction) << seed;
    ++told;
  }
  EXPECT_GE(told, 2);
}

TEST(ResponseFriction, IsNotSeenWhereThereIsNone) {
  for (const ExcitationKind kind : {ExcitationKind::noise, ExcitationKind::linear_chirp}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Recording recording = rubbed(0.0, kind, seed);
      EXPECT_THAT(frequency_response(recording).trust.reasons, ::testing::Not(says_friction)) << seed;
    }
  }
}

// In periods that repeat nothing tells friction from damping, but a second force does.
TEST(ResponseFriction, AForceThatRepeatsIsDoubtfulUntilThereIsASecondOne) {
  const auto says_so = Contains(HasSubstr("a force that repeats hides dry friction"));
  const Recording once = rubbed(0.3, ExcitationKind::multisine, 1);
  EXPECT_THAT(frequency_response(once).trust.reasons, says_so);
  for (const double coulomb : {0.0, 0.3}) {
    std::vector<Recording> twice{rubbed(coulomb, ExcitationKind::multisine, 1),
                                 rubbed(coulomb, ExcitationKind::multisine, 2, 16.0)};
    twice[1].source = "harder";
    const MeasuredResponse found = frequency_response(twice);
    EXPECT_THAT(found.trust.reasons, ::testing::Not(says_so));
    EXPECT_EQ(found.dependence.has_value(), coulomb > 0.0);
  }
}

TEST(ResponseFriction, OfARecordThatIsTooShortOrDoesNotMoveIsNothing) {
  const Recording recording = rubbed(0.3, ExcitationKind::noise, 1);
  const FrequencyResponse response = frequency_response(recording).response;
  const std::vector<double>& force = recording.channels[0].samples;
  const std::vector<double>& position = recording.channels[1].samples;
  EXPECT_TRUE(internal::find_friction_beside(response, force, position));
  EXPECT_FALSE(internal::find_friction_beside(response, std::span(force).first(500), std::span(position).first(500)));
  EXPECT_FALSE(
      internal::find_friction_beside(response, std::vector<double>(4000, 0.0), std::vector<double>(4000, 0.0)));
}

}  // namespace
}  // namespace zwidth
