// Dry friction beside a measured response: simulated rigid bodies that rub, and the same without.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "identification/friction_body.hpp"
#include "identification/response/hidden_friction.hpp"
#include "identification/simulated_record.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/identification/measured_response.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// 10 s at 1 kHz, from 0.5 Hz on.
std::vector<double> ten_seconds(ExcitationKind kind, double amplitude, double highest_hz, std::uint64_t seed) {
  ExcitationOptions options;
  options.kind = kind;
  options.amplitude = amplitude;
  options.duration = 10.0;
  options.rate = 1e3;
  options.lowest_hz = 0.5;
  options.highest_hz = highest_hz;
  options.seed = seed;
  return excite(options).samples;
}

/// 10 s at 1 kHz of 1.2 kg, 2 N s/m under noise, a sweep or a multisine.
Recording rubbed(double coulomb, ExcitationKind kind, std::uint64_t seed, double amplitude = 8.0,
                 test::FrictionBody body = {.mass = 1.2, .viscous = 2.0}) {
  body.coulomb = coulomb;
  Recording recording{"run", 1e-3, {{"force", ten_seconds(kind, amplitude, 200.0, seed)}, {"position", {}}}, {}};
  for (const double force : recording.channels[0].samples) {
    recording.channels[1].samples.push_back(body.position);
    body.move(force, 1e-3);
  }
  return recording;
}

/// Position noise of a micrometre.
Recording noisy(Recording recording, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (double& each : recording.channels[1].samples) each += 1e-6 * normal(random);
  return recording;
}

const auto says_friction = Contains(HasSubstr("dry friction, which the response takes for damping"));

/// What a record of this response shows.
std::optional<internal::HiddenForces> shown(const Recording& recording) {
  const FrequencyResponse response = frequency_response(recording).response;
  return internal::hidden_forces(std::span(&recording, 1), std::span(&response, 1), {});
}

TEST(ResponseFriction, ShowsInAMultisineWithoutNoise) {
  ExcitationOptions options;
  options.kind = ExcitationKind::multisine;
  options.amplitude = 8.0;
  options.duration = 10.0;
  options.rate = 1e3;
  options.lowest_hz = 0.5;
  options.highest_hz = 40.0;
  options.periods = 1;
  options.seed = 1;
  for (const double coulomb : {0.1, 0.3, 0.6}) {
    test::FrictionBody body{.mass = 1.2, .viscous = 10.0};
    body.coulomb = coulomb;
    Recording recording{"run", 1e-3, {{"force", excite(options).samples}, {"position", {}}}, {}};
    for (const double force : recording.channels[0].samples) {
      recording.channels[1].samples.push_back(body.position);
      body.move(force, 1e-3);
    }
    const auto found = shown(recording);
    ASSERT_TRUE(found) << coulomb;
    EXPECT_NEAR(found->friction.size, coulomb, 0.1 * coulomb);
    EXPECT_GT(found->friction.size, 3.5 * found->friction.deviation);
  }
}

TEST(ResponseFriction, IsNotSeenWhereThereIsNone) {
  for (const ExcitationKind kind : {ExcitationKind::noise, ExcitationKind::linear_chirp}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Recording recording = rubbed(0.0, kind, seed);
      EXPECT_THAT(frequency_response(recording).trust.reasons, ::testing::Not(says_friction)) << seed;
    }
  }
}

// Friction of 1 to 10 % of the force: no sound interval lies more than 10 % above the truth.
TEST(ResponseFriction, NoStiffnessIsSoundThatFrictionHasRaised) {
  const test::FrictionBody damped{.mass = 0.5, .viscous = 4.0};
  DeviceParameters rigid;
  rigid.bodies = {{"body", damped.mass, damped.viscous, 0.0, 0.0}};
  rigid.loop = {0, 0, 0, 1e-3, 0.0};
  const double truth = critical_stiffness(Device(rigid)).stiffness;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (const double coulomb : {0.05, 0.15, 0.5}) {
      const MeasuredResponse found =
          frequency_response(noisy(rubbed(coulomb, ExcitationKind::multisine, seed, 5.0, damped), seed));
      if (!found.trust.sound()) continue;
      EXPECT_LE(stiffness_interval(*found.stiffness)->lower, 1.1 * truth) << coulomb << " " << seed;
    }
  }
}

// The rest that no friction explains is a micrometre of noise: so little friction passes unseen that records stay
// sound.
TEST(ResponseFriction, ALinearDeviceIsSoundWhereTheNoiseIsLow) {
  int sound = 0;
  int all = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    for (const ExcitationKind kind : {ExcitationKind::noise, ExcitationKind::linear_chirp, ExcitationKind::multisine}) {
      const test::FrictionBody damped{.mass = 0.5, .viscous = 4.0};
      std::vector<Recording> two{noisy(rubbed(0.0, kind, seed, 8.0, damped), seed),
                                 noisy(rubbed(0.0, kind, seed + 10, 20.0, damped), seed + 10)};
      two[1].source = "harder";
      const MeasuredResponse found = frequency_response(two);
      if (found.trust.refused()) continue;
      ++all;
      sound += found.trust.sound() ? 1 : 0;
      const MeasuredResponse one = frequency_response(two[1]);
      if (one.trust.refused()) continue;
      ++all;
      sound += one.trust.sound() ? 1 : 0;
    }
  }
  EXPECT_GE(all, 15);
  EXPECT_GE(10 * sound, 8 * all) << sound << " of " << all;
}

// What shows of friction and drag is less than there is: a doubt, however narrow the interval.
TEST(ResponseFriction, WhatShowsIsADoubt) {
  const test::FrictionBody damped{.mass = 0.5, .viscous = 4.0};
  const auto doubts = [](const MeasuredResponse& found, FindingCode code) {
    return std::ranges::any_of(found.trust.findings, [&](const Finding& each) { return each.code == code; });
  };
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto of = [&](double coulomb) {
      return frequency_response(noisy(rubbed(coulomb, ExcitationKind::multisine, seed, 5.0, damped), seed));
    };
    EXPECT_TRUE(doubts(of(0.5), FindingCode::motion_shows_friction)) << seed;
    const MeasuredResponse linear = of(0.0);
    EXPECT_FALSE(doubts(linear, FindingCode::motion_shows_friction)) << seed;
    EXPECT_FALSE(doubts(linear, FindingCode::motion_shows_drag)) << seed;
  }
}

// A second amplitude would tell what passes for damping.
TEST(ResponseFriction, OneAmplitudeIsNoted) {
  const test::FrictionBody damped{.mass = 0.5, .viscous = 4.0};
  std::vector<Recording> two{noisy(rubbed(0.0, ExcitationKind::noise, 1, 8.0, damped), 1),
                             noisy(rubbed(0.0, ExcitationKind::noise, 11, 20.0, damped), 11)};
  two[1].source = "harder";
  const auto is_noted = [](const MeasuredResponse& found) {
    EXPECT_TRUE(found.trust.sound());
    return std::ranges::any_of(found.remarks, [](const Remark& remark) {
      return remark.finding && remark.finding->code == FindingCode::one_amplitude;
    });
  };
  EXPECT_TRUE(is_noted(frequency_response(two[1])));
  EXPECT_FALSE(is_noted(frequency_response(two)));
}

TEST(ResponseFriction, ATableIsTrustedNoMoreThanItSaysOfItself) {
  const test::FrictionBody damped{.mass = 0.5, .viscous = 4.0};
  const Recording recording = noisy(rubbed(0.0, ExcitationKind::noise, 1, 20.0, damped), 1);
  FrequencyResponse table = frequency_response(recording).response;
  const MeasuredResponse silent = judged_response("table", table);
  EXPECT_TRUE(silent.trust.sound());
  EXPECT_TRUE(std::ranges::any_of(silent.remarks, [](const Remark& remark) {
    return remark.finding && remark.finding->code == FindingCode::table_hides_friction;
  }));
  table.trust.emplace();
  EXPECT_TRUE(judged_response("table", table).trust.sound());
  for (const auto verdict : {Trust::Verdict::doubtful, Trust::Verdict::refused}) {
    for (const std::vector<std::string>& reasons : {std::vector<std::string>{"dry friction"}, {}}) {
      table.trust = Trust{verdict, reasons};
      const MeasuredResponse found = judged_response("table", table);
      EXPECT_EQ(found.trust.verdict, verdict);
      EXPECT_EQ(found.trust.reasons.size(), 1U);
      EXPECT_EQ(stiffness_interval(*found.stiffness).has_value(), verdict == Trust::Verdict::doubtful);
    }
  }
}

TEST(ResponseFriction, OfARecordThatIsTooShortOrDoesNotMoveIsNothing) {
  const Recording recording = rubbed(0.3, ExcitationKind::noise, 1);
  const FrequencyResponse response = frequency_response(recording).response;
  Recording part = recording;
  for (Channel& channel : part.channels) channel.samples.resize(30);
  EXPECT_FALSE(internal::hidden_forces(std::span(&part, 1), std::span(&response, 1), {}));
  Recording still = recording;
  for (Channel& channel : still.channels) channel.samples.assign(4000, 0.0);
  EXPECT_FALSE(internal::hidden_forces(std::span(&still, 1), std::span(&response, 1), {}));
}

}  // namespace
}  // namespace zwidth
