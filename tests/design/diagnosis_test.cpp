#include "zwidth/design/diagnosis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/critical_damping.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;

// docs/theory.md, "What is added": K_CR = 8848.7 at 38.6 rad/s; any user: 5776 at 260 rad/s.
const Device& lhifam() {
  static const Device device(test::lhifam_parameters());
  return device;
}

TEST(Diagnosis, NamesTheDeviceItself) {
  const Diagnosis diagnosis = diagnose(lhifam(), {.frequency = 39.5, .stiffness = 9200.0});
  EXPECT_EQ(diagnosis.cause, OscillationCause::device);
  EXPECT_EQ(diagnosis.candidates.front().limited_by->kind, Oscillator::Kind::rigid_body);
  EXPECT_NEAR(*diagnosis.candidates.front().stiffness, 8848.70869499712, 1e-6);
}

TEST(Diagnosis, NamesAUserWhereTheDeviceAloneIsStable) {
  const Diagnosis diagnosis = diagnose(lhifam(), {.frequency = 259.9, .stiffness = 5900.0});
  EXPECT_EQ(diagnosis.cause, OscillationCause::passive_user);
  EXPECT_NEAR(*diagnosis.candidates.front().stiffness, 5776.09, 0.1);
}

// A rigid device of 6.1 kg at T = 0.25 ms: K_CR = 2 b / T = 4000 N/m, growing at 4.64 Hz with 5200 N/m. On a wall that
// only pushes it swings at 3.29 Hz, which is no user's doing.
TEST(Diagnosis, BlamesNoUserForALoopThatIsUnstableByItself) {
  DeviceParameters device;
  device.name = "rigid";
  device.bodies = {{"b0", 6.107564301523623, 0.5}};
  device.loop.sampling_period = 0.25e-3;
  device.actuator.force_limit = 2.0;
  const Diagnosis diagnosis = diagnose(Device(device), {.frequency = 2.0 * pi * 3.287, .stiffness = 5200.0});
  EXPECT_EQ(diagnosis.cause, OscillationCause::device);
  EXPECT_EQ(diagnosis.trust.verdict, Trust::Verdict::doubtful);  // of the frequency
  const auto user =
      std::ranges::find(diagnosis.candidates, OscillationCause::passive_user, &OscillationCandidate::cause);
  ASSERT_NE(user, diagnosis.candidates.end());
  EXPECT_FALSE(user->fits);
}

// The limit with any user is 14 % away.
TEST(Diagnosis, WhereNothingFitsTheNearestIsNamedAndWhatWouldHaveToBeOtherwise) {
  const Diagnosis diagnosis = diagnose(lhifam(), {.frequency = 259.9, .stiffness = 5000.0});
  EXPECT_FALSE(diagnosis.cause);
  EXPECT_EQ(diagnosis.nearest, OscillationCause::passive_user);
  EXPECT_EQ(diagnosis.trust.verdict, Trust::Verdict::doubtful);
  for (const OscillationCandidate& each : diagnosis.candidates) {
    EXPECT_FALSE(each.fits);
    EXPECT_NE(each.why.code, FindingCode::stated);
  }
  const OscillationCandidate& user = diagnosis.candidates.front();
  EXPECT_NEAR(user.otherwise.value().limit, 5000.0 / 5776.09, 1e-4);
  EXPECT_EQ(user.otherwise->frequency, 1.0);
  EXPECT_NEAR(user.stiffness.value(), 5776.09, 1.0);
  // The device itself: its own limit would have to be K.
  const OscillationCandidate& device = diagnosis.candidates.at(1);
  EXPECT_EQ(device.cause, OscillationCause::device);
  EXPECT_NEAR(device.otherwise.value().limit * device.stiffness.value(), 5000.0, 1e-9);
  // What moves it is told as if the limit were that much lower.
  ASSERT_FALSE(diagnosis.changes.empty());
  for (const DiagnosisChange& each : diagnosis.changes) {
    const double stiffness = each.key == "wall.stiffness" ? each.value_then : 5000.0;
    EXPECT_EQ(each.ends_it.value(), user.otherwise->limit * *each.limit_then > stiffness) << each.key;
  }
}

TEST(Diagnosis, NamesNothingWhereNothingIsNear) {
  // A sixth of any user's limit, no encoder, no friction.
  const Diagnosis diagnosis = diagnose(lhifam(), {.frequency = 259.9, .stiffness = 1000.0});
  EXPECT_FALSE(diagnosis.cause);
  EXPECT_FALSE(diagnosis.nearest);
  EXPECT_TRUE(diagnosis.changes.empty());
  EXPECT_TRUE(diagnosis.trust.sound());
}

// A crossover a fifth higher than what was heard.
TEST(Diagnosis, ANearFrequencyIsTheNearestCause) {
  const Device plant(test::transfer_function_parameters({1.0}, {5.4, 3.5, 0.0}, 1e-3));
  const Crossover crossover = critical_stiffness(plant).limit.value();
  const Diagnosis diagnosis = diagnose(plant, {.frequency = 0.8 * crossover.frequency});
  EXPECT_FALSE(diagnosis.cause);
  EXPECT_EQ(diagnosis.nearest, OscillationCause::device);
  EXPECT_NEAR(diagnosis.candidates.front().otherwise.value().frequency, 0.8, 1e-12);
  EXPECT_FALSE(diagnosis.changes.empty());
}

// A person lets go: what the operator of the file keeps stable is the device's own.
TEST(Diagnosis, WhatTheOperatorKeepsStableIsTheDevicesOwn) {
  DeviceParameters held = test::lhifam_parameters();
  held.user = {0.0, 6.0, 0.0};
  const Diagnosis diagnosis = diagnose(Device(held), {.frequency = 39.5, .stiffness = 9200.0});
  EXPECT_TRUE(critical_stiffness(Device(held)).stiffness > 9200.0);
  EXPECT_EQ(diagnosis.cause, OscillationCause::device);
  const auto softer = std::ranges::find(diagnosis.changes, "wall.stiffness", &DiagnosisChange::key);
  ASSERT_NE(softer, diagnosis.changes.end());
  EXPECT_LT(softer->value_then, critical_stiffness(lhifam()).stiffness);
}

// The damper that was proposed, "ends it: yes", lets some user destabilise every wall: 924 N/m became none.
TEST(Diagnosis, NoDamperIsProposedWithWhichSomeUserDestabilisesEveryWall) {
  DeviceParameters parameters;
  parameters.name = "light";
  parameters.bodies = {{"motor", 0.076, 0.976}, {"handle", 0.0629, 0.405}};
  parameters.links = {{0, 1, 87.3e3, 2.49}};
  parameters.loop = {0, 0, 1, 1e-3, 1e-3};
  const Device device(parameters);
  const CriticalStiffness now = critical_stiffness(device);
  parameters.wall.damping = 13.81;
  EXPECT_EQ(absolute_stability_limit(Device(parameters), {13.81, 0.0}).stiffness, 0.0);
  const double any_user = absolute_stability_limit(device).stiffness;
  const Diagnosis diagnosis = diagnose(device, {.frequency = now.limit->frequency, .stiffness = 1.05 * now.stiffness});
  EXPECT_EQ(diagnosis.cause, OscillationCause::device);
  EXPECT_DOUBLE_EQ(diagnosis.absolute_stability_limit_now.value(), any_user);
  const auto damper = std::ranges::find(diagnosis.changes, "wall.damping", &DiagnosisChange::key);
  ASSERT_NE(damper, diagnosis.changes.end());
  EXPECT_TRUE(damper->safe.value());
  bool lowers_before = false;
  for (const DiagnosisChange& each : diagnosis.changes) {
    SCOPED_TRACE(words_of(each));
    EXPECT_EQ(each.safe.value(), each.absolute_stability_limit_then.value() >= any_user * (1.0 - 1e-9));
    EXPECT_FALSE(lowers_before && *each.safe) << "what lowers it comes last";
    lowers_before = !*each.safe;
    if (each.key != "wall.damping") continue;
    DeviceParameters then = device.parameters();
    then.wall.damping = each.value_then;
    EXPECT_DOUBLE_EQ(*each.absolute_stability_limit_then,
                     absolute_stability_limit(Device(then), virtual_damper(Device(then))).stiffness);
  }
}

/// A wheel whose controller renders a damper alone.
Device damped_rotor(double damping) {
  DeviceParameters parameters;
  parameters.name = "wheel";
  parameters.motion = Motion::rotary;
  parameters.bodies = {{"rotor", 2e-6, 2e-5}};
  parameters.loop = {0, 0, 0, 1e-3, 1e-3};
  parameters.wall.stiffness = 0.0;
  parameters.wall.damping = damping;
  return Device(parameters);
}

double excess_of(const Device& device) {
  return stability_excess(sample(state_space(device), {device.loop().sampling_period, device.loop().delay}),
                          device.parameters().wall, CountedPoles::but_free_position);
}

// It shook at 165.1 Hz by a factor of 1.569 a sample; a user's grasp was blamed.
TEST(Diagnosis, ADamperAloneIsDiagnosedByItsOwnLimit) {
  const Device device = damped_rotor(0.006);
  EXPECT_NEAR(1.0 + excess_of(device), 1.569, 5e-4);
  const Diagnosis diagnosis = diagnose(device, {.frequency = 2.0 * pi * 165.1});
  EXPECT_EQ(diagnosis.cause, OscillationCause::device);
  EXPECT_EQ(diagnosis.limit_of, WallNumber::damping);
  EXPECT_EQ(diagnosis.stiffness, 0.0);
  const OscillationCandidate& cause = diagnosis.candidates.front();
  EXPECT_FALSE(cause.stiffness);
  const double limit = critical_damping(device).damping;
  EXPECT_DOUBLE_EQ(cause.damping.value(), limit);
  EXPECT_LT(excess_of(damped_rotor(limit * (1.0 - 1e-6))), 0.0);
  EXPECT_GT(excess_of(damped_rotor(limit * (1.0 + 1e-6))), 0.0);
  // What cures cures, by poles.
  int ending = 0;
  for (const DiagnosisChange& each : diagnosis.changes) {
    SCOPED_TRACE(words_of(each));
    EXPECT_DOUBLE_EQ(each.limit_now.value(), limit);
    DeviceParameters then = device.parameters();
    if (each.key == "body.*.damping") {
      then.bodies[0].damping = each.value_then;
    } else {
      set_parameter(then, each.key, each.value_then);
    }
    if (each.delay_then) then.loop.damper->delay = each.delay_then;
    EXPECT_EQ(each.ends_it.value(), excess_of(with_loop_of_damper(Device(then))) < 0.0);
    EXPECT_NEAR(*each.limit_then / critical_damping(Device(then)).damping, 1.0, 1e-12);
    EXPECT_NEAR(*each.absolute_stability_limit_then / absolute_stability_damping(Device(then)).damping, 1.0, 1e-9);
    EXPECT_EQ(each.safe.value(),
              *each.absolute_stability_limit_then >= *diagnosis.absolute_stability_limit_now * (1.0 - 1e-9));
    ending += *each.ends_it ? 1 : 0;
  }
  EXPECT_GE(ending, 1);
  // The same from the options, over a file that says otherwise.
  DeviceParameters other = device.parameters();
  other.wall = {};
  const Diagnosis asked = diagnose(Device(other), {.frequency = 2.0 * pi * 165.1, .stiffness = 0.0, .damping = 0.006});
  EXPECT_EQ(asked.cause, OscillationCause::device);
  EXPECT_EQ(asked.changes.size(), diagnosis.changes.size());
}

// Nothing damps the bodies: the virtual damper is taken from the wall.
TEST(Diagnosis, ADamperIsProposedWhereNoBodyHasOne) {
  DeviceParameters parameters;
  parameters.name = "undamped";
  parameters.bodies = {{"rotor", 0.1, 0.0}};
  parameters.loop.sampling_period = 1e-3;
  parameters.wall.stiffness = 100.0;
  const Diagnosis diagnosis = diagnose(Device(parameters), {.frequency = std::sqrt(1000.0)});
  EXPECT_EQ(diagnosis.cause, OscillationCause::device);
  const auto damper = std::ranges::find(diagnosis.changes, "wall.damping", &DiagnosisChange::key);
  ASSERT_NE(damper, diagnosis.changes.end());
  EXPECT_TRUE(damper->ends_it.value());
  parameters.wall.damping = damper->value_then;
  EXPECT_LT(excess_of(Device(parameters)), 0.0);
}

TEST(Diagnosis, AGraspThatMakesADamperOscillateIsNamed) {
  DeviceParameters parameters;
  parameters.name = "light";
  parameters.bodies = {{"motor", 0.076, 0.976}, {"handle", 0.0629, 0.405}};
  parameters.links = {{0, 1, 87.3e3, 2.49}};
  parameters.loop = {0, 0, 1, 1e-3, 1e-3};
  parameters.wall.stiffness = 0.0;
  const AbsoluteStabilityDamping any_user = absolute_stability_damping(Device(parameters));
  const double alone = critical_damping(Device(parameters)).damping;
  ASSERT_LT(any_user.damping, 0.9 * alone);
  ASSERT_GT(any_user.frequency, 0.0);
  parameters.wall.damping = std::min(1.05 * any_user.damping, 0.5 * (any_user.damping + alone));
  const Diagnosis diagnosis = diagnose(Device(parameters), {.frequency = any_user.frequency});
  EXPECT_EQ(diagnosis.cause, OscillationCause::passive_user);
  EXPECT_NEAR(diagnosis.candidates.front().damping.value() / any_user.damping, 1.0, 1e-3);
  EXPECT_EQ(diagnosis.absolute_stability_limit_now, any_user.damping);
}

TEST(Diagnosis, ChangesAreWhatTheLibraryComputes) {
  const Diagnosis diagnosis = diagnose(lhifam(), {.frequency = 259.9, .stiffness = 5900.0});
  const auto damped = std::ranges::find(diagnosis.changes, "body.*.damping", &DiagnosisChange::key);
  ASSERT_NE(damped, diagnosis.changes.end());
  DeviceParameters parameters = test::lhifam_parameters();
  for (Body& body : parameters.bodies) body.damping *= 1.2;
  EXPECT_DOUBLE_EQ(*damped->limit_then, absolute_stability_limit(Device(parameters)).stiffness);
  EXPECT_EQ(*damped->ends_it, *damped->limit_then > 5900.0);
  EXPECT_TRUE(std::ranges::is_sorted(diagnosis.changes, std::greater<>(),
                                     [](const DiagnosisChange& each) { return *each.limit_then; }));
  for (const DiagnosisChange& each : diagnosis.changes)
    EXPECT_EQ(each.absolute_stability_limit_then, each.limit_then) << words_of(each);
}

// A damper of 20 times was the first remedy, which makes the wall half as stiff as leaving the filter out; without the
// filter the damper is more than the device's own, and every wall has a user who destabilises it.
TEST(Diagnosis, ASlowVelocityFilterIsAmongWhatMovesIt) {
  DeviceParameters slow;
  slow.name = "slow filter";
  slow.bodies = {{"body", 1.54, 4.86}};
  slow.loop = {0, 0, 0, 1e-3, 0.0};
  slow.actuator.time_constant = 1e-4;
  slow.wall.damping = 38.8;
  slow.wall.velocity_filter_hz = 8.44;
  const CriticalStiffness now = critical_stiffness(Device(slow));
  const Diagnosis diagnosis =
      diagnose(Device(slow), {.frequency = now.limit->frequency, .stiffness = 1.03 * now.stiffness});
  const auto unfiltered = std::ranges::find(diagnosis.changes, "wall.velocity_filter_hz", &DiagnosisChange::key);
  ASSERT_NE(unfiltered, diagnosis.changes.end());
  EXPECT_EQ(unfiltered->value_then, 0.0);
  EXPECT_EQ(unfiltered->absolute_stability_limit_then, 0.0);
  EXPECT_FALSE(unfiltered->safe.value());
  EXPECT_TRUE(diagnosis.changes.front().safe.value());
  const auto faster = std::ranges::find(diagnosis.changes, "actuator.time_constant", &DiagnosisChange::key);
  ASSERT_NE(faster, diagnosis.changes.end());
  EXPECT_DOUBLE_EQ(faster->value_then, 0.5e-4);
  slow.wall.velocity_filter_hz = 0.0;
  EXPECT_DOUBLE_EQ(*unfiltered->limit_then, critical_stiffness(Device(slow)).stiffness);
  for (const DiagnosisChange& each : diagnosis.changes) {
    if (each.safe.value()) {
      EXPECT_LT(*each.limit_then, *unfiltered->limit_then) << words_of(each);
    }
  }
}

TEST(Diagnosis, WithoutAStiffnessACrossoverIsNamedAndWhatComesFirst) {
  const Diagnosis diagnosis = diagnose(lhifam(), {.frequency = 618.0});
  ASSERT_TRUE(diagnosis.cause);
  EXPECT_EQ(diagnosis.cause, OscillationCause::device);
  EXPECT_EQ(diagnosis.candidates.front().limited_by->mode, 1);
  const Finding& why = diagnosis.candidates.front().why;
  EXPECT_EQ(why.code, FindingCode::crossover_at_frequency);
  EXPECT_NE(std::ranges::find(why.evidence, "softest", &Evidence::name), why.evidence.end());
  EXPECT_FALSE(diagnosis.remarks.empty());
}

TEST(Diagnosis, ADoubtfulDeviceIsDoubtfulAndARefusedOneHoldsNothing) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.uncertainty.emplace();
  parameters.uncertainty->warning = "a guess";
  EXPECT_EQ(diagnose(Device(parameters), {.frequency = 39.5, .stiffness = 9200.0}).trust.verdict,
            Trust::Verdict::doubtful);
  parameters.uncertainty->verdict = Trust::Verdict::refused;
  const Diagnosis refused = diagnose(Device(parameters), {.frequency = 39.5, .stiffness = 9200.0});
  EXPECT_TRUE(refused.trust.refused());
  EXPECT_TRUE(refused.candidates.empty());
  EXPECT_FALSE(refused.cause);
}

TEST(Diagnosis, NamesTheMemberOutsideItsRange) {
  EXPECT_EQ(find_problem(DiagnosisOptions{.frequency = 0.0}, lhifam())->member, "frequency");
  EXPECT_EQ(find_problem(DiagnosisOptions{.frequency = 1.01e3 * pi}, lhifam())->member, "frequency");
  EXPECT_EQ(find_problem(DiagnosisOptions{.frequency = 10.0, .amplitude = -1.0}, lhifam())->member, "amplitude");
  EXPECT_EQ(find_problem(DiagnosisOptions{.frequency = 10.0, .stiffness = -1.0}, lhifam())->member, "stiffness");
  EXPECT_FALSE(find_problem(DiagnosisOptions{.frequency = 10.0, .stiffness = 0.0, .damping = 1.0}, lhifam()));
  EXPECT_EQ(find_problem(DiagnosisOptions{.frequency = 10.0, .stiffness = 0.0}, lhifam())->member, "stiffness");
  EXPECT_EQ(find_problem(DiagnosisOptions{.frequency = 10.0, .damping = -1.0}, lhifam())->member, "damping");
  EXPECT_THROW(static_cast<void>(diagnose(lhifam(), {})), Error);
}

TEST(Diagnosis, OfARecordingIsThatOfWhatOscillatesInIt) {
  Recording recording{"run", 1e-3, {{"position", std::vector<double>(8192)}}, {}};
  std::vector<double>& samples = recording.channels.front().samples;
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k] = 2e-3 * std::sin(39.5e-3 * static_cast<double>(k));
  recording.remarks.push_back({Remark::Severity::warning, "a gap", ""});
  const DiagnosisOptions options{.stiffness = 9200.0};
  const Diagnosis heard = diagnose(lhifam(), recording, options);
  EXPECT_NEAR(*heard.frequency, 39.5, 0.2);
  EXPECT_NEAR(*heard.amplitude, 2e-3, 1e-5);
  EXPECT_EQ(heard.cause, diagnose(lhifam(), {.frequency = 39.5, .amplitude = 2e-3, .stiffness = 9200.0}).cause);
  EXPECT_EQ(heard.remarks.front().what, "a gap");
  EXPECT_EQ(*diagnose(lhifam(), recording, {.amplitude = 1e-5}).amplitude, 1e-5);

  EXPECT_EQ(find_problem({.stiffness = -1.0}, lhifam(), recording)->member, "stiffness");
  recording.sampling_period = 1e-5;  // 3950 rad/s, beyond Nyquist of the device
  EXPECT_EQ(find_problem(options, lhifam(), recording)->member, "recording");
  EXPECT_THROW(static_cast<void>(diagnose(lhifam(), recording, options)), Error);

  std::ranges::fill(samples, 1.0);
  const Diagnosis still = diagnose(lhifam(), recording, options);
  EXPECT_TRUE(still.trust.refused());
  EXPECT_FALSE(still.frequency);
}

/// 4 s at 1 kHz.
Diagnosis diagnosed(const std::function<double(double)>& position) {
  Recording recording{"run", 1e-3, {{"position", std::vector<double>(4000)}}, {}};
  std::vector<double>& samples = recording.channels.front().samples;
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k] = position(1e-3 * static_cast<double>(k));
  return diagnose(lhifam(), recording, {.stiffness = 9200.0});
}

TEST(Diagnosis, OfWhatDoesNotOscillateIsRefused) {
  std::mt19937 engine(3);
  std::normal_distribution<double> noise(0.0, 1e-4);
  EXPECT_TRUE(diagnosed([&](double) { return noise(engine); }).trust.refused());
  // From 1 to 260 Hz.
  EXPECT_TRUE(diagnosed([](double t) { return 1e-3 * std::sin(2.0 * pi * (1.0 + 32.4 * t) * t); }).trust.refused());
  // All that is left of a ramp is rounding.
  EXPECT_TRUE(diagnosed([](double t) { return 1e-3 * t; }).trust.refused());
}

TEST(Diagnosis, OfWhatDiesOutOrIsLostInOtherMotionIsDoubtful) {
  const auto swing = [](double t) { return 1e-3 * std::sin(39.5 * t); };
  EXPECT_TRUE(diagnosed(swing).trust.sound());
  EXPECT_TRUE(diagnosed([&](double t) { return std::exp(0.5 * t) * swing(t); }).trust.sound());
  const Diagnosis decaying = diagnosed([&](double t) { return std::exp(-t) * swing(t); });
  EXPECT_EQ(decaying.trust.verdict, Trust::Verdict::doubtful);
  EXPECT_EQ(decaying.trust.reasons.back(),
            "the oscillation dies out, to 37 % from one half of the stretch to the other: nothing keeps it up; "
            "record it while it goes on");
  EXPECT_EQ(decaying.trust.findings.back().code, FindingCode::oscillation_dies_out);
  EXPECT_EQ(decaying.trust.findings.back().severity, Finding::Severity::doubt);
  std::mt19937 engine(3);
  std::normal_distribution<double> noise(0.0, 1.2e-3);
  const Diagnosis hidden = diagnosed([&](double t) { return swing(t) + noise(engine); });
  EXPECT_EQ(hidden.trust.verdict, Trust::Verdict::doubtful);
  EXPECT_NEAR(*hidden.frequency, 39.5, 0.3);
}

}  // namespace
}  // namespace zwidth
