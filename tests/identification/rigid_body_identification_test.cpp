// Inverse dynamics, judged: a device that is not rigid, a reversed position, a column of another quantity, a clean rigid body.
#include "zwidth/identification/rigid_body_identification.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "campaign.hpp"
#include "identification/friction_body.hpp"
#include "identification/synthetic_response.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

using ::testing::Contains;
using ::testing::Field;
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
    const Analysis analysis = analyze_fit(found);
    EXPECT_EQ(analysis.trust, found.trust) << "seed " << seed;
    ASSERT_TRUE(analysis.interval && analysis.limits.any_user) << "seed " << seed;
    EXPECT_LE(analysis.limits.any_user->critical_stiffness, analysis.critical.stiffness) << "seed " << seed;
  }
}

/// 2.3 kg, 2.5 N s/m, 0.3 N, pushed by a force that acts `delay` late; 5 % of it is not recorded.
struct Bench {
  double highest_hz = 1.0;
  double delay = 0.0;
  double amplitude = 5.0;
};
constexpr double bench_period = 1e-3;

Recording recorded(const Bench& bench, std::uint64_t seed) {
  ExcitationOptions excitation;
  excitation.kind = ExcitationKind::noise;
  excitation.amplitude = bench.amplitude;
  excitation.lowest_hz = 0.3;
  excitation.highest_hz = bench.highest_hz;
  excitation.seed = seed;
  const std::vector<double> force = excite(excitation).samples;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 0.05);
  std::vector<double> felt = force;
  for (double& each : felt) each += normal(random);
  constexpr double encoder = 3e-6;
  constexpr int parts = 20;  // of a period
  const auto late = static_cast<int>(std::lround(bench.delay / bench_period * parts));
  test::FrictionBody body{2.3, 2.5, 0.3};
  std::vector<double> position;
  for (int k = 0; k < static_cast<int>(felt.size()); ++k) {
    position.push_back(encoder * std::round(body.position / encoder));
    for (int part = 0; part < parts; ++part) {
      const int at = k * parts + part - late;
      body.move(at < 0 ? 0.0 : felt[static_cast<std::size_t>(at / parts)], bench_period / parts);
    }
  }
  return {"simulated", bench_period, {{"force", force}, {"position", position}}, {}};
}

double true_limit(const Bench& bench) {
  DeviceParameters device;
  device.bodies = {{"body", 2.3, 2.5, 0.0, 0.0}};
  device.loop = {0, 0, 0, bench_period, bench.delay};
  return critical_stiffness(Device(device)).stiffness;
}

bool holds(const RigidBodyIdentification& found, double limit) {
  const auto interval = analyze(found.device, {.any_user = false}).interval;
  return interval && interval->lower <= limit && limit <= interval->upper;
}

// Sound 5017 [4913, 5129] where 1667 is true: the device had no delay, though it was known to a millisecond only.
TEST(RigidBodyIdentification, ALimitAboveTheBandIsDoubtfulAndItsIntervalHoldsTheTruth) {
  for (const double delay : {0.2e-3, 1e-3}) {
    int held = 0;
    const unsigned seeds = test::by_tier(6U, 20U);
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const Bench bench{1.0, delay};
      const RigidBodyIdentification found = identify_rigid_body(recorded(bench, seed));
      EXPECT_EQ(found.trust.verdict, Trust::Verdict::doubtful) << "seed " << seed;
      EXPECT_THAT(found.trust.findings, Contains(Field(&Finding::code, FindingCode::limit_outside_band)))
          << "seed " << seed;
      const DeviceParameters& device = found.device.parameters();
      EXPECT_GE(device.loop.delay, 0.0);
      ASSERT_TRUE(device.uncertainty) << "seed " << seed;
      EXPECT_THAT(device.uncertainty->parameters, Contains("loop.delay")) << "seed " << seed;
      held += holds(found, true_limit(bench)) ? 1 : 0;
    }
    EXPECT_GE(held, 0.9 * seeds) << "delay " << delay;
  }
}

TEST(RigidBodyIdentification, ADelayInTheBandIsTheDevicesAndSound) {
  int held = 0;
  const unsigned seeds = test::by_tier(6U, 20U);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Bench bench{20.0, 0.5e-3, 10.0};
    const RigidBodyIdentification found = identify_rigid_body(recorded(bench, seed));
    EXPECT_TRUE(found.trust.sound()) << "seed " << seed << (found.trust.sound() ? "" : found.trust.reasons.front());
    EXPECT_NEAR(found.device.loop().delay, 0.5e-3, 0.03e-3) << "seed " << seed;
    held += holds(found, true_limit(bench)) ? 1 : 0;
  }
  EXPECT_GE(held, 0.85 * seeds);
}

// Excited to 0.4 Hz: 43 ms came out, and were advised, where 0.35 ms is true.
TEST(RigidBodyIdentification, ADelayThatDoesNotShowIsNotAdvised) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Bench bench{0.6, 0.35e-3};
    const RigidBodyIdentification found = identify_rigid_body(recorded(bench, seed));
    EXPECT_THAT(found.trust.findings, Contains(Field(&Finding::code, FindingCode::data_leave_interval_open)))
        << "seed " << seed;
    EXPECT_TRUE(holds(found, true_limit(bench))) << "seed " << seed;
    for (const Remark& remark : found.remarks)
      EXPECT_FALSE(remark.finding && remark.finding->code == FindingCode::force_acts_later) << seed;
  }
}

// A mode at 28 or 54 Hz of which nothing shows but that the inertia rises: 1.4 to 3.4 % off, 5 to 10 times the interval.
TEST(RigidBodyIdentification, AModeAboveTheBandDoesNotBiasTheInertia) {
  for (const auto& [mode_hz, highest_hz] : {std::pair{28.0, 3.0}, std::pair{54.0, 5.0}, std::pair{54.0, 8.0}}) {
    const unsigned seeds = test::by_tier(4U, 10U);
    int held = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const RigidBodyIdentification found =
          identify_rigid_body(recorded(body_of_one_kilogram(mode_hz), highest_hz, seed));
      held += *found.fit.mass.lower <= 1.0 && *found.fit.mass.upper >= 1.0 ? 1 : 0;
      EXPECT_NEAR(found.fit.mass.value, 1.0, 0.015) << "seed " << seed;
      EXPECT_EQ(found.trust.verdict, Trust::Verdict::doubtful) << "mode " << mode_hz << " seed " << seed;
    }
    EXPECT_GE(held, 0.9 * seeds) << "mode " << mode_hz << " excited to " << highest_hz;
  }
}

TEST(RigidBodyIdentification, AReversedPositionIsRefused) {
  Recording recording = recorded(body_of_one_kilogram(0.0), 20.0, 1);
  for (double& value : recording.channels[1].samples) value = -value;
  EXPECT_THROW((void)identify_rigid_body(recording), Error);
}

TEST(RigidBodyIdentification, MovesAsItsColumnsState) {
  Recording recording = recorded(body_of_one_kilogram(0.0), 20.0, 1);
  EXPECT_EQ(identify_rigid_body(recording).device.parameters().motion, Motion::linear);
  recording.channels[1].base_unit = "rad";
  EXPECT_EQ(identify_rigid_body(recording).device.parameters().motion, Motion::rotary);
  RigidBodyOptions options;
  options.motion = Motion::linear;
  const RigidBodyIdentification other = identify_rigid_body(recording, options);
  EXPECT_EQ(other.device.parameters().motion, Motion::linear);
  EXPECT_FALSE(other.trust.sound());
  EXPECT_NE(other.trust.reasons.front().find("every number has the wrong unit"), std::string::npos);
}

TEST(RigidBodyIdentification, AColumnOfAnotherQuantityIsDoubtful) {
  Recording recording = recorded(body_of_one_kilogram(0.0), 20.0, 1);
  recording.channels[1].quantity = StatedQuantity::velocity;
  recording.channels[1].unit = "m/s";
  EXPECT_THAT(identify_rigid_body(recording).trust.findings,
              Contains(Field(&Finding::code, FindingCode::channel_of_other_quantity)));
}

TEST(RigidBodyIdentification, AForceOfOtherBodiesIsRefused) {
  Recording recording = recorded(body_of_one_kilogram(0.0), 20.0, 1);
  const std::vector<double> other = recorded(body_of_one_kilogram(0.0), 20.0, 2).channels[0].samples;
  for (std::size_t k = 0; k < other.size(); ++k) recording.channels[0].samples[k] += 2.0 * other[k];
  const RigidBodyIdentification found = identify_rigid_body(recording);
  EXPECT_TRUE(found.trust.refused());
  EXPECT_THAT(found.trust.findings, Contains(Field(&Finding::code, FindingCode::force_unexplained)));
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
