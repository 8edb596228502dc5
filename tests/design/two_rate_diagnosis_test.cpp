// An oscillation of a device whose damper runs in a loop of its own.

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <optional>

#include "lhifam.hpp"
#include "zwidth/design/diagnosis.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;
using Kind = DiagnosisChange::Kind;

Device with_own_loop(double spring_period, double damper_period, double damping) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.loop.sampling_period = spring_period;
  parameters.loop.damper = LoopDamper{damper_period, damper_period};
  parameters.loop.delay = damper_period;
  parameters.wall.damping = damping;
  return Device(parameters);
}

Device with_stiffness(const Device& device, double stiffness) {
  DeviceParameters parameters = device.parameters();
  parameters.wall.stiffness = stiffness;
  return Device(parameters);
}

const OscillationCandidate* find(const Diagnosis& diagnosis, OscillationCause cause) {
  const auto found = std::ranges::find(diagnosis.candidates, cause, &OscillationCandidate::cause);
  return found == diagnosis.candidates.end() ? nullptr : &*found;
}

bool leaves_out(const Diagnosis& diagnosis, std::string_view what) {
  return std::ranges::any_of(diagnosis.remarks, [&](const Remark& each) {
    return each.finding && each.finding->code == FindingCode::left_out_beside_damper_loop &&
           each.finding->subjects.front().text == what;
  });
}

// The device that a change of one number makes.
Device changed(const Device& device, const DiagnosisChange& change) {
  DeviceParameters parameters = device.parameters();
  if (change.key == "body.*.damping") {
    for (Body& body : parameters.bodies) body.damping *= change.value_then / change.value_now;
  } else {
    set_parameter(parameters, change.key, change.value_then);
  }
  return Device(std::move(parameters));
}

TEST(TwoRateDiagnosis, NamesTheDeviceAndEachLimitIsThatOfTheChangedDevice) {
  for (const Device& device : {with_own_loop(1e-3, 1e-4, 200.0), with_own_loop(1e-4, 4e-4, 100.0)}) {
    const CriticalStiffness critical = critical_stiffness(device);
    const double stiffness = 1.02 * critical.stiffness;
    const Diagnosis diagnosis = diagnose(device, {.frequency = critical.limit->frequency, .stiffness = stiffness});
    EXPECT_EQ(diagnosis.cause, OscillationCause::device);
    EXPECT_NEAR(*diagnosis.candidates.front().stiffness, critical.stiffness, 1e-9 * critical.stiffness);
    for (const Kind kind : {Kind::half_delay, Kind::half_damper_delay, Kind::twice_sampling_rate,
                            Kind::twice_damper_rate, Kind::other_damper, Kind::stiffer_link}) {
      EXPECT_NE(std::ranges::find(diagnosis.changes, kind, &DiagnosisChange::kind), diagnosis.changes.end());
    }
    for (const DiagnosisChange& change : diagnosis.changes) {
      SCOPED_TRACE(change.key);
      if (change.kind == Kind::softer_wall) continue;
      const Device then = changed(device, change);
      ASSERT_TRUE(change.limit_then.has_value());
      // Eigenvalues of the loop as it runs.
      EXPECT_TRUE(wall_margins(with_stiffness(then, 0.999 * *change.limit_then)).stable);
      EXPECT_FALSE(wall_margins(with_stiffness(then, 1.001 * *change.limit_then)).stable);
      EXPECT_EQ(*change.ends_it, *change.limit_then > stiffness);
    }
  }
}

TEST(TwoRateDiagnosis, NamesAUserWhereTheDeviceAloneIsStable) {
  const Device device = with_own_loop(1e-3, 1e-4, 200.0);
  const Analysis analysis = analyze(device);
  ASSERT_TRUE(analysis.any_user.has_value());
  const double limit = analysis.any_user->stiffness;
  ASSERT_LT(limit, 0.99 * analysis.critical.stiffness);
  const Diagnosis diagnosis = diagnose(device, {.frequency = analysis.any_user->frequency, .stiffness = 1.01 * limit});
  EXPECT_EQ(diagnosis.cause, OscillationCause::passive_user);
  EXPECT_NEAR(*diagnosis.candidates.front().stiffness, limit, 1e-6 * limit);
  EXPECT_NEAR(*diagnosis.absolute_stability_limit_now, limit, 1e-12 * limit);
  for (const DiagnosisChange& change : diagnosis.changes) {
    if (change.key != "link.0.stiffness" && change.key != "wall.damping") continue;
    const Analysis then = analyze(changed(device, change));
    ASSERT_TRUE(then.any_user && change.limit_then);
    EXPECT_NEAR(*change.limit_then, then.any_user->stiffness, 1e-9 * then.any_user->stiffness);
    EXPECT_EQ(change.safe, then.any_user->stiffness >= limit * (1.0 - 1e-9));
  }
}

TEST(TwoRateDiagnosis, LooksForNoUserWhereTheirLimitIsNotKnown) {
  const Diagnosis slower = diagnose(with_own_loop(5e-4, 1e-3, 100.0), {.frequency = 1500.0, .stiffness = 3e5});
  EXPECT_EQ(find(slower, OscillationCause::passive_user), nullptr);
  EXPECT_TRUE(leaves_out(slower, "any_user"));
  EXPECT_FALSE(slower.absolute_stability_limit_now.has_value());
}

TEST(TwoRateDiagnosis, LeavesOutTheEncodersCycle) {
  DeviceParameters parameters = with_own_loop(1e-3, 1e-4, 200.0).parameters();
  parameters.sensor.resolution = 1e-6;
  const Diagnosis diagnosis = diagnose(Device(parameters), {.frequency = 1200.0, .amplitude = 1e-6, .stiffness = 3e5});
  EXPECT_EQ(find(diagnosis, OscillationCause::quantisation), nullptr);
  EXPECT_TRUE(leaves_out(diagnosis, "steps"));
}

// Either part of the wall alone runs in one loop.
TEST(TwoRateDiagnosis, OneForceAloneIsThatOfItsLoop) {
  const Device apart = with_own_loop(1e-3, 1e-4, 9000.0);
  const Diagnosis damper = diagnose(apart, {.frequency = 2.0 * pi * 2830.0, .stiffness = 0.0});
  const Diagnosis alone = diagnose(with_loop_of_damper(apart), {.frequency = 2.0 * pi * 2830.0, .stiffness = 0.0});
  ASSERT_EQ(damper.candidates.size(), alone.candidates.size());
  for (std::size_t i = 0; i < alone.candidates.size(); ++i) {
    EXPECT_EQ(damper.candidates[i].cause, alone.candidates[i].cause);
    EXPECT_EQ(damper.candidates[i].frequency, alone.candidates[i].frequency);
    EXPECT_EQ(damper.candidates[i].damping, alone.candidates[i].damping);
  }
  EXPECT_EQ(std::ranges::find(damper.changes, std::string("loop.delay"), &DiagnosisChange::key), damper.changes.end());
  EXPECT_NE(std::ranges::find(damper.changes, Kind::half_damper_delay, &DiagnosisChange::kind), damper.changes.end());
  const DiagnosisOptions spring{.frequency = 40.0, .stiffness = 9000.0, .damping = 0.0};
  EXPECT_EQ(diagnose(apart, spring).candidates.front().stiffness,
            diagnose(with_one_rate(apart), spring).candidates.front().stiffness);
}

TEST(TwoRateDiagnosis, SeesUpToNyquistOfTheFasterLoop) {
  const Device device = with_own_loop(1e-3, 1e-4, 200.0);
  EXPECT_FALSE(find_problem({.frequency = 2.0 * pi * 4900.0, .stiffness = 4e5}, device).has_value());
  EXPECT_TRUE(find_problem({.frequency = 2.0 * pi * 5100.0, .stiffness = 4e5}, device).has_value());
}

}  // namespace
}  // namespace zwidth
