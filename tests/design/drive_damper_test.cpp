// A damper that the drive closes in a loop of its own: what it gives a device of one rate, and the walls of two rates.

#include "zwidth/design/drive_damper.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "lhifam.hpp"
#include "stability/users/any_user_limit.hpp"
#include "stability/users/two_rate_users.hpp"
#include "zwidth/design/design_target.hpp"
#include "zwidth/design/diagnosis.hpp"
#include "zwidth/design/wall_recommendation.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"

namespace zwidth {
namespace {

Device held_by_cable(double delay = 0.0) { return Device(test::with_delay(test::lhifam_parameters(), delay)); }

Device walled_with(Device device, double stiffness, double damping, double filter = 0.0) {
  DeviceParameters parameters = device.parameters();
  parameters.wall.stiffness = stiffness;
  parameters.wall.damping = damping;
  parameters.wall.velocity_filter_hz = filter;
  return Device(parameters);
}

double any_users_limit(const Device& device) { return internal::any_user_limit(device)->stiffness; }

TEST(DriveDamper, RunsAtTheWholePartNearestToEightKilohertz) {
  const auto timing = [](double period, double delay) -> std::optional<DamperTiming> {
    DeviceParameters parameters = test::with_delay(test::lhifam_parameters(), delay);
    parameters.loop.sampling_period = period;
    const auto on_drive = with_damper_on_drive(Device(parameters));
    return on_drive ? std::optional(damper_timing(on_drive->loop())) : std::nullopt;
  };
  EXPECT_DOUBLE_EQ(timing(1e-3, 0.0)->sampling_period, 1.25e-4);
  EXPECT_DOUBLE_EQ(timing(1e-3, 0.0)->delay, 1.25e-4);
  EXPECT_DOUBLE_EQ(timing(3e-4, 0.0)->sampling_period, 1.5e-4);
  EXPECT_NEAR(timing(1e-3, 2.6e-4)->delay, 1.35e-4, 1e-18);
  EXPECT_NEAR(timing(1e-3, 1e-3)->delay, 1.25e-4, 1e-18);
  EXPECT_FALSE(timing(1.5e-4, 0.0));
  EXPECT_FALSE(with_damper_on_drive(*with_damper_on_drive(held_by_cable())));
  DeviceParameters filtered = test::lhifam_parameters();
  filtered.wall.filters.push_back({.kind = WallFilter::Kind::low_pass, .frequency_hz = 100.0});
  EXPECT_FALSE(with_damper_on_drive(Device(filtered)));
}

// The delays differ by a whole number of the damper's periods whatever the loop's is: every user is known.
TEST(DriveDamper, EveryUserIsKnownAtAnyDelay) {
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> delays(0.0, 3e-3);
  for (int i = 0; i < 100; ++i) {
    const double delay = delays(engine);
    EXPECT_TRUE(internal::knows_all_users(with_damper_on_drive(held_by_cable(delay))->loop())) << delay;
  }
}

// What searches look at is no bound from below, and near.
TEST(DriveDamper, ASearchSeesTheLimitOfAnyUserFromAbove) {
  for (const double delay : {0.0, 2.5e-4}) {
    const Device on_drive = *with_damper_on_drive(held_by_cable(delay));
    const internal::TwoRateUsers users(on_drive);
    for (const double damping : {10.0, 100.0, 500.0}) {
      const double exact = any_users_limit(walled_with(on_drive, 0.0, damping));
      const double nobody = critical_stiffness(walled_with(on_drive, 0.0, damping)).stiffness;
      const double seen = std::min(nobody, users.limit_on_grid({damping, 0.0}));
      EXPECT_GE(seen, exact * (1.0 - 1e-6)) << damping;
      EXPECT_LE(seen, exact * 1.02) << damping;
    }
  }
}

void expect_kept_margins(const Device& device, const RecommendedWall& wall, double gain, double phase) {
  const double stiffness = *wall.wall.stiffness;
  const double filter = wall.wall.velocity_filter_hz;
  for (const double factor : {1.0, std::sqrt(gain), gain}) {
    const double grown = factor == 1.0 ? gain : factor;
    EXPECT_LT(grown * stiffness,
              any_users_limit(walled_with(device, 0.0, factor * wall.wall.damping, filter)) * (1.0 + 1e-6));
  }
  const WallMargins margins = wall_margins(walled_with(device, stiffness, wall.wall.damping, filter));
  EXPECT_TRUE(margins.stable);
  EXPECT_LT(margins.spectral_radius, 1.0);
  EXPECT_GE(margins.stiffness_margin.value_or(gain), gain * (1.0 - 1e-6));
  EXPECT_GE(margins.phase_margin.value_or(phase), phase * (1.0 - 1e-6));
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> log_user(-3.0, 3.0);
  for (int i = 0; i < 30; ++i) {
    const User user{std::pow(10.0, log_user(engine)), 0.0, stiffness * std::pow(10.0, log_user(engine))};
    const Device held = device_with_user(walled_with(device, 0.0, wall.wall.damping, filter), user);
    EXPECT_GT(critical_stiffness(held).stiffness, gain * stiffness) << user.mass << " " << user.stiffness;
  }
}

TEST(DriveDamper, TheWallOfTwoRatesKeepsItsMarginsWhoeverHolds) {
  for (const double delay : {0.0, 2.5e-4}) {
    const Device device = *with_damper_on_drive(held_by_cable(delay));
    const RecommendationOptions options;
    const WallRecommendation answer = recommend_wall(device, options);
    ASSERT_EQ(answer.status, WallRecommendation::Status::found);
    EXPECT_TRUE(answer.trust.sound());
    expect_kept_margins(device, *answer.wall, options.gain_margin, options.phase_margin);
    EXPECT_FALSE(answer.alternatives.empty());
    for (const RecommendedWall& each : answer.alternatives) {
      SCOPED_TRACE(words_of(each.kind));
      expect_kept_margins(device, each, options.gain_margin, options.phase_margin);
      EXPECT_LE(*each.wall.stiffness, *answer.wall->wall.stiffness * (1.0 + 1e-6));
    }
    EXPECT_FALSE(answer.wall->contact_damping_ratio);
  }
}

TEST(DriveDamper, AOneRateRecommendationSaysWhatItWouldGive) {
  const WallRecommendation one = recommend_wall(held_by_cable(), {.alternatives = false, .drive_damper = true});
  ASSERT_TRUE(one.drive_damper);
  const DriveDamper& found = *one.drive_damper;
  const WallRecommendation two = recommend_wall(*with_damper_on_drive(held_by_cable()), {.alternatives = false});
  EXPECT_EQ(found.stiffness, *two.wall->wall.stiffness);
  EXPECT_EQ(found.damping, two.wall->wall.damping);
  EXPECT_EQ(found.one_rate_stiffness, *one.wall->wall.stiffness);
  EXPECT_DOUBLE_EQ(found.gain, found.stiffness / found.one_rate_stiffness);
  EXPECT_GT(found.gain, 2.0);
  EXPECT_DOUBLE_EQ(found.sampling_period, 1.25e-4);
  EXPECT_EQ(found.why.code, FindingCode::damper_on_drive);
  EXPECT_EQ(found.why.key, "loop.damper.sampling_period");
  EXPECT_FALSE(recommend_wall(held_by_cable(), {.alternatives = false}).drive_damper);  // unless asked
}

// Of a device whose encoder is known the finding says what one count then does.
TEST(DriveDamper, ItsFindingHasTheForcePerCount) {
  DeviceParameters parameters = held_by_cable().parameters();
  parameters.sensor.resolution = 3.14e-6;
  const Device device(parameters);
  const auto found = recommend_wall(device, {.alternatives = false, .drive_damper = true}).drive_damper;
  ASSERT_TRUE(found);
  const auto per_count = std::ranges::find(found->why.evidence, "force_per_count", &Evidence::name);
  ASSERT_NE(per_count, found->why.evidence.end());
  const Device walled =
      walled_with(*with_damper_on_drive(device), found->stiffness, found->damping, found->velocity_filter_hz);
  EXPECT_EQ(per_count->value, force_per_count(walled)->largest);
}

TEST(DriveDamper, TheEncodersStepsBoundItsWall) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.sensor.resolution = 3.14e-6;
  const Device device = *with_damper_on_drive(Device(parameters));
  const double most = 0.5;
  const WallRecommendation answer = recommend_wall(device, {.quantisation_force = most, .alternatives = false});
  ASSERT_TRUE(answer.wall);
  const Wall& wall = answer.wall->wall;
  const double largest =
      force_per_count(walled_with(device, *wall.stiffness, wall.damping, wall.velocity_filter_hz))->largest;
  EXPECT_LE(largest, most * (1.0 + 1e-9));
  EXPECT_EQ(largest, answer.wall->force_per_count->largest);
}

TEST(DriveDamper, ADamperAloneRunsInItsOwnLoop) {
  const Device device = *with_damper_on_drive(held_by_cable());
  const WallRecommendation answer = recommend_wall(device, {.goal = WallGoal::damper});
  ASSERT_TRUE(answer.wall);
  EXPECT_EQ(*answer.wall->wall.stiffness, 0.0);
  const WallRecommendation alone = recommend_wall(with_loop_of_damper(device), {.goal = WallGoal::damper});
  EXPECT_EQ(answer.wall->wall.damping, alone.wall->wall.damping);
  const Device damped = walled_with(device, 0.0, answer.wall->wall.damping, answer.wall->wall.velocity_filter_hz);
  EXPECT_EQ(*answer.wall->absolute_stability_limit, any_users_limit(damped));
}

TEST(DriveDamper, UncertainNumbersSoftenItsWall) {
  DeviceParameters parameters = with_damper_on_drive(held_by_cable())->parameters();
  const double certain = *recommend_wall(Device(parameters), {.alternatives = false}).wall->wall.stiffness;
  parameters.uncertainty = Uncertainty{};
  parameters.uncertainty->parameters = {"body.motor.mass"};
  parameters.uncertainty->covariance = {{0.03 * 0.03}};
  const WallRecommendation answer = recommend_wall(Device(parameters), {.alternatives = false, .draws = 40});
  ASSERT_TRUE(answer.wall);
  EXPECT_LT(*answer.wall->wall.stiffness, certain);
  EXPECT_EQ(answer.wall->bounded_by.stiffness, WallBound::uncertainty);
}

// With a slower damper, and with delays a part of a period apart, no limit over all passive users is known.
TEST(DriveDamper, WithoutALimitOfAllUsersNoWallIsProposed) {
  DeviceParameters slow = test::lhifam_parameters();
  slow.loop.damper = LoopDamper{.sampling_period = 2e-3, .delay = 0.0};
  EXPECT_THROW((void)recommend_wall(Device(slow)), Error);
  DeviceParameters apart = test::lhifam_parameters();
  apart.loop.damper = LoopDamper{.sampling_period = 1e-4, .delay = 0.5e-4};
  EXPECT_THROW((void)recommend_wall(Device(apart)), Error);
  const auto problem =
      find_problem(RecommendationOptions{.goal = WallGoal::critical_damping}, *with_damper_on_drive(held_by_cable()));
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->member, "goal");
}

TEST(DriveDamper, OneRateWrittenAsTwoIsOneRate) {
  DeviceParameters same = test::rigid_parameters();
  const WallRecommendation one = recommend_wall(Device(same), {.alternatives = false});
  same.loop.damper = LoopDamper{.sampling_period = 1e-3, .delay = 0.0};
  const WallRecommendation two = recommend_wall(Device(same), {.alternatives = false});
  EXPECT_EQ(*one.wall->wall.stiffness, *two.wall->wall.stiffness);
  EXPECT_EQ(one.wall->wall.damping, two.wall->wall.damping);
}

TEST(DriveDamper, ATargetSaysWhatItAllows) {
  for (const StiffnessGoal goal : {StiffnessGoal::critical_stiffness, StiffnessGoal::absolute_stability_limit}) {
    const DesignTargets targets = design_targets(held_by_cable(), {.goal = goal, .factor = 2.0, .times_now = 2.0});
    ASSERT_TRUE(targets.drive_damper);
    const DriveDamper& found = *targets.drive_damper;
    const Device with = walled_with(*with_damper_on_drive(held_by_cable()), 0.0, found.damping);
    const Device without = walled_with(held_by_cable(), 0.0, found.one_rate_damping);
    const bool any_user = goal == StiffnessGoal::absolute_stability_limit;
    EXPECT_EQ(*found.absolute_stability_limit, any_users_limit(with));
    EXPECT_EQ(found.stiffness, any_user ? any_users_limit(with) : critical_stiffness(with).stiffness);
    EXPECT_EQ(found.one_rate_stiffness, any_user ? any_users_limit(without) : critical_stiffness(without).stiffness);
    // No B of a ladder is better.
    for (const double damping : {50.0, 100.0, 200.0, 400.0, 800.0, 1600.0}) {
      EXPECT_LE(any_users_limit(walled_with(*with_damper_on_drive(held_by_cable()), 0.0, damping)),
                *found.absolute_stability_limit * 1.02);
      if (!any_user) continue;
      EXPECT_LE(any_users_limit(walled_with(held_by_cable(), 0.0, damping)), found.one_rate_stiffness * 1.02);
    }
  }
}

TEST(DriveDamper, IsACureOfWhatOscillates) {
  for (const double damping : {0.0, 20.0}) {
    const Device device = walled_with(held_by_cable(), 0.0, damping);
    const CriticalStiffness now = critical_stiffness(device);
    const Diagnosis diagnosis =
        diagnose(device, {.frequency = now.limit->frequency, .stiffness = 1.05 * now.stiffness});
    const auto cure =
        std::ranges::find(diagnosis.changes, DiagnosisChange::Kind::damper_on_drive, &DiagnosisChange::kind);
    ASSERT_NE(cure, diagnosis.changes.end());
    EXPECT_EQ(cure->key, "loop.damper.sampling_period");
    EXPECT_EQ(cure->value_now, 1e-3);
    EXPECT_DOUBLE_EQ(cure->value_then, 1.25e-4);
    EXPECT_DOUBLE_EQ(cure->delay_then.value(), 1.25e-4);
    const Device then = walled_with(*with_damper_on_drive(device), 0.0, cure->damping_then.value());
    EXPECT_EQ(cure->limit_then, critical_stiffness(then).stiffness);
    EXPECT_EQ(cure->absolute_stability_limit_then, any_users_limit(then));
    EXPECT_TRUE(cure->ends_it.value());
    EXPECT_TRUE(cure->safe.value());
  }
}

}  // namespace
}  // namespace zwidth
