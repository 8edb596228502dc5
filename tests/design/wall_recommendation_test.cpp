#include "zwidth/design/wall_recommendation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "lhifam.hpp"
#include "zwidth/design/drive_damper.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
namespace {

Device rigid(double mass, double damping, double period) {
  DeviceParameters parameters;
  parameters.bodies.push_back({"body", mass, damping});
  parameters.loop.sampling_period = period;
  return Device(parameters);
}

// A rigid device, a spring alone, no phase margin: every passive user's limit is 2 b/T (Colgate & Schenkel), and less
// with any damper; so the wall is that over the gain margin.
TEST(WallRecommendation, OfARigidDeviceIsColgateAndSchenkelsOverTheMargin) {
  const WallRecommendation answer =
      recommend_wall(rigid(5.4, 3.5, 1e-3), {.gain_margin = 2.0, .phase_margin = 0.0, .notch = false});
  ASSERT_TRUE(answer.wall);
  EXPECT_NEAR(*answer.wall->wall.stiffness, 3500.0, 3500.0 * 2e-5);
  EXPECT_EQ(answer.wall->bounded_by.stiffness, WallBound::any_user);
}

TEST(WallRecommendation, RippleBoundsStiffnessAndDampingTogether) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.sensor.resolution = 3.14e-6;
  const Device device(parameters);
  double softer = 0.0;
  for (const double quantisation_force : {0.003, 0.01, 0.03, 0.1, 0.3}) {
    const WallRecommendation answer = recommend_wall(device, {.quantisation_force = quantisation_force});
    ASSERT_TRUE(answer.wall);
    EXPECT_LE(answer.wall->force_per_count->largest, quantisation_force * (1.0 + 1e-12));
    EXPECT_GE(*answer.wall->wall.stiffness, softer);
    softer = *answer.wall->wall.stiffness;
  }
}

// One count that takes the force from end to end makes a relay of any wall: no ripple need be asked for that.
TEST(WallRecommendation, OneCountTakesNoMoreThanTheForceLimit) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.sensor.resolution = 1e-3;
  const WallRecommendation unlimited = recommend_wall(Device(parameters), {.alternatives = false});
  parameters.actuator.force_limit = 5.0;
  const Device device(parameters);
  const WallRecommendation limited = recommend_wall(device, {.alternatives = false});
  ASSERT_TRUE(unlimited.wall && limited.wall);
  EXPECT_GT(unlimited.wall->force_per_count->largest, 5.0);
  EXPECT_LE(limited.wall->force_per_count->largest, 5.0 * (1.0 + 1e-12));
  EXPECT_TRUE(std::ranges::any_of(limited.remarks, [](const Remark& remark) {
    return remark.finding && remark.finding->code == FindingCode::no_ripple_asked;
  }));
  const WallRecommendation on_drive = recommend_wall(*with_damper_on_drive(device), {.alternatives = false});
  ASSERT_TRUE(on_drive.wall);
  EXPECT_LE(on_drive.wall->force_per_count->largest, 5.0 * (1.0 + 1e-9));
}

TEST(WallRecommendation, CriticalDampingMeansRealPolesOfTheContact) {
  const WallRecommendation answer =
      recommend_wall(rigid(1.0, 20.0, 1e-3), {.goal = WallGoal::critical_damping, .notch = false});
  ASSERT_TRUE(answer.wall);
  EXPECT_GE(*answer.wall->contact_damping_ratio, 1.0 - 1e-6);
  EXPECT_EQ(answer.wall->bounded_by.stiffness, WallBound::contact_damping);
}

// A damper alone on a rigid device without delay: any passive user's limit is the device's own damping (Colgate &
// Schenkel: b > K T/2 + |B|); so the damper without a filter is that over the margin. A slow filter makes a larger B of it.
TEST(WallRecommendation, ADamperAloneOnARigidDeviceIsItsOwnDampingOverTheMargin) {
  const WallRecommendation answer =
      recommend_wall(rigid(5.4, 3.5, 1e-3), {.goal = WallGoal::damper, .gain_margin = 2.0, .phase_margin = 0.0});
  ASSERT_EQ(answer.status, WallRecommendation::Status::found);
  ASSERT_TRUE(answer.wall);
  EXPECT_EQ(answer.wall->wall.stiffness, 0.0);
  EXPECT_EQ(answer.wall->bounded_by.damping, WallBound::any_user);
  EXPECT_GT(answer.wall->wall.velocity_filter_hz, 0.0);
  EXPECT_GT(answer.wall->wall.damping, 1.75);
  EXPECT_NEAR(answer.wall->absolute_stability_damping_limit.value() / answer.wall->wall.damping, 2.0, 1e-4);
  EXPECT_TRUE(answer.wall->margins.stable);
  EXPECT_GE(answer.wall->margins.gain_margin.value(), 2.0);
  ASSERT_EQ(answer.alternatives.size(), 1U);
  const RecommendedWall& plain = answer.alternatives.front();
  EXPECT_EQ(plain.wall.velocity_filter_hz, 0.0);
  EXPECT_NEAR(plain.wall.damping, 1.75, 1.75 * 2e-5);
  EXPECT_NEAR(plain.absolute_stability_damping_limit.value(), 3.5, 3.5 * 2e-5);
}

TEST(WallRecommendation, ADamperAloneKeepsWhatIsAskedByASecondRoute) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.sensor.resolution = 3.14e-6;
  const Device device(parameters);
  const WallRecommendation answer = recommend_wall(device, {.goal = WallGoal::damper});
  ASSERT_TRUE(answer.wall);
  const Wall& wall = answer.wall->wall;
  EXPECT_EQ(wall.stiffness, 0.0);
  EXPECT_GE(answer.wall->margins.phase_margin.value(), std::numbers::pi / 6.0 * (1.0 - 1e-6));
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> decade(-3.0, 6.0);
  for (int i = 0; i < 200; ++i) {  // poles of the damper grown by the margin, held by springs and masses
    DeviceParameters held = parameters;
    held.wall = wall;
    held.wall.damping *= 2.0;
    held.user = {i % 2 == 0 ? std::pow(10.0, decade(engine) - 3.0) : 0.0, 0.0, std::pow(10.0, decade(engine))};
    const Device each(held);
    EXPECT_LT(stability_excess(sample(state_space(each), {1e-3, 0.0}), held.wall), 1e-9)
        << held.user.mass << " " << held.user.stiffness;
  }
  // A ripple bounds it.
  const double quantisation_force = 0.5 * answer.wall->force_per_count->largest;
  const WallRecommendation quiet =
      recommend_wall(device, {.goal = WallGoal::damper, .quantisation_force = quantisation_force});
  ASSERT_TRUE(quiet.wall);
  EXPECT_LE(quiet.wall->force_per_count->largest, quantisation_force * (1.0 + 1e-12));
}

TEST(WallRecommendation, NoDamperIsRecommendedWhereSomeUserDestabilisesAny) {
  const WallRecommendation answer = recommend_wall(rigid(1.0, 0.0, 1e-3), {.goal = WallGoal::damper});
  EXPECT_EQ(answer.status, WallRecommendation::Status::none);
  EXPECT_FALSE(answer.wall);
}

// m s² + b s + K, sampled fast: b / (2 sqrt(K m)), less what half a period of delay takes.
TEST(WallRecommendation, DampingRatioOfTheContact) {
  DeviceParameters parameters = rigid(2.0, 8.0, 1e-6).parameters();
  parameters.wall.stiffness = 50.0;
  EXPECT_NEAR(*contact_damping_ratio(Device(parameters)), 8.0 / (2.0 * std::sqrt(50.0 * 2.0)), 1e-5);
}

// A device known to 20 % in its damping: the wall holds for 97.5 % of such devices, drawn here by another generator.
TEST(WallRecommendation, OfAnUncertainDeviceHoldsAtTheLowerEndProperty) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.uncertainty = Uncertainty{{"body.handle.damping", "link.0.damping"},
                                       {{0.2 * 0.2 * 3.4 * 3.4, 0.0}, {0.0, 0.2 * 0.2 * 15.0 * 15.0}}};
  const Device device(parameters);
  const WallRecommendation answer = recommend_wall(device);
  ASSERT_TRUE(answer.wall);
  const Wall& wall = answer.wall->wall;
  parameters.uncertainty.reset();
  const WallRecommendation certain = recommend_wall(Device(parameters));
  EXPECT_LE(*wall.stiffness, *certain.wall->wall.stiffness * (1.0 + 1e-9));
  std::mt19937 engine(20261122);
  std::normal_distribution<double> normal(1.0, 0.2);
  int kept = 0;
  constexpr int devices = 400;
  for (int i = 0; i < devices; ++i) {
    DeviceParameters drawn = parameters;
    drawn.bodies[1].damping *= std::abs(normal(engine));
    drawn.links[0].damping *= std::abs(normal(engine));
    drawn.wall = wall;
    const Device each(drawn);
    if (2.0 * *wall.stiffness < absolute_stability_limit(each, virtual_damper(each)).stiffness) ++kept;
  }
  EXPECT_GE(kept, devices * 95 / 100) << "seed 20261122";
}

TEST(WallRecommendation, ATransferFunctionIsWarnedAbout) {
  DeviceParameters parameters;
  parameters.transfer_function = TransferFunction{{1.0}, {1.0, 3.0, 0.0}};
  parameters.loop.sampling_period = 1e-3;
  const WallRecommendation answer = recommend_wall(Device(parameters));
  ASSERT_TRUE(answer.wall);
  EXPECT_FALSE(answer.wall->absolute_stability_limit);
  bool warned = false;
  for (const Remark& each : answer.remarks) {
    warned = warned ||
             (each.severity == Remark::Severity::warning && each.what.find("any passive user") != std::string::npos);
  }
  EXPECT_TRUE(warned);
}

// The held body has no damping, and is driven itself: users leave 30 nN/m of 52 N/m at most.
TEST(WallRecommendation, NextToNothingIsNoWall) {
  DeviceParameters parameters;
  parameters.bodies = {{"far", 0.35211050663092236, 0.3824210949641596},
                       {"held", 0.06991810606866407, 0.0, 4.2929035999047995}};
  parameters.links = {{0, 1, 152744.04831067976, 0.0}};
  parameters.loop = {.actuated = 1, .sensed = 1, .held = 1, .sampling_period = 0.0002612985474436173};
  parameters.actuator.time_constant = 0.0011612128976711035;
  const Device device(std::move(parameters));
  const WallRecommendation found = recommend_wall(device);
  EXPECT_NE(found.status, WallRecommendation::Status::found);
  EXPECT_FALSE(found.wall);
  EXPECT_LE(absolute_stability_limit(device).stiffness, 31e-9);
}

TEST(WallRecommendation, NamesTheMemberOutsideItsRange) {
  const Device device = rigid(1.0, 1.0, 1e-3);
  EXPECT_EQ(find_problem(RecommendationOptions{.gain_margin = 0.9}, device)->member, "gain_margin");
  EXPECT_EQ(find_problem(RecommendationOptions{.gain_margin = 0.1}, device)->what, "is -20 dB, a factor of 0.1");
  EXPECT_EQ(find_problem(RecommendationOptions{.phase_margin = 2.0}, device)->member, "phase_margin");
  EXPECT_EQ(find_problem(RecommendationOptions{.quantisation_force = -1.0}, device)->member, "quantisation_force");
  EXPECT_EQ(find_problem(RecommendationOptions{.draws = 0}, device)->member, "draws");
  EXPECT_THROW(static_cast<void>(recommend_wall(device, {.gain_margin = std::nan("")})), Error);
}

// Damped on one body, which stands still at 1.65 times Nyquist: a spring that resonates there leaves 4.895 N/m alone.
TEST(WallRecommendation, IsSafeForAUserWhoResonatesWhereTheDampedBodyStandsStill) {
  DeviceParameters device;
  device.bodies = {{"m", 0.56, 1e-4, 0.0, 0.0}, {"x", 1.3, 26.0, 0.0, 0.0}, {"y", 0.057, 0.0, 0.0, 0.0}};
  device.links = {{0, 1, 4.77e6, 0.0}, {1, 2, 1.53e6, 0.0}};
  device.loop = {0, 0, 0, 1e-3, 0.0};
  const WallRecommendation answer = recommend_wall(Device(device));
  ASSERT_TRUE(answer.wall);
  const Wall& wall = answer.wall->wall;
  const AbsoluteStabilityLimit limit =
      absolute_stability_limit(Device(device), {wall.damping, wall.velocity_filter_hz});
  EXPECT_TRUE(limit.trust.sound());
  EXPECT_LE(*wall.stiffness * 2.0, limit.stiffness * (1.0 + 1e-9));
  EXPECT_NEAR(absolute_stability_limit(Device(device)).stiffness, 4.016853, 1e-5);
}

}  // namespace
}  // namespace zwidth
