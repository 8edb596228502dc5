// Recordings that were sound although the answer was up to five times too high: what made it so is in the record, or in the
// structure beside it (a tester's, with a simulator of his own).

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "campaign.hpp"
#include "identification/synthetic_response.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/time_domain.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::doubted_recording_test {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double period = 1e-3;

DeviceParameters two_bodies() {
  DeviceParameters device;
  device.name = "two bodies";
  device.bodies = {{"motor", 0.3, 0.2}, {"handle", 1.2, 1.5}};
  device.links = {{0, 1, 20e3, 6.0}};
  device.loop = {0, 0, 1, period, 1e-3};
  return device;
}

std::vector<double> noise_force(ExcitationKind kind = ExcitationKind::noise) {
  ExcitationOptions excitation;
  excitation.kind = kind;
  excitation.amplitude = 5.0;
  excitation.lowest_hz = 1.0;
  excitation.highest_hz = 200.0;
  excitation.duration = 20.0;
  return excite(excitation).samples;
}

Recording recorded(const DeviceParameters& device, std::vector<double> force) {
  std::vector<double> position = test::synthetic_position(Device(device), force, {0.0, 1e-6, 1});
  return {"record", period, {{"force", std::move(force)}, {"position", std::move(position)}}, {}};
}

/// The handle rubs half as much again until a share of the record has passed.
Recording warming_up(double share, std::vector<double> force) {
  DeviceParameters cold = two_bodies();
  for (Body& body : cold.bodies) body.damping *= 1.5;
  cold.links[0].damping *= 1.5;
  const auto with = [](const DeviceParameters& device) {
    return sample(state_space(Device(device)), {device.loop.sampling_period, device.loop.delay});
  };
  const DiscreteStateSpace before = with(cold);
  const DiscreteStateSpace after = with(two_bodies());
  const auto turn = static_cast<std::size_t>(share * static_cast<double>(force.size()));
  Eigen::VectorXd state = Eigen::VectorXd::Zero(before.Phi.rows());
  std::vector<double> position;
  for (std::size_t k = 0; k < force.size(); ++k) {
    position.push_back(before.C * state);
    const DiscreteStateSpace& now = k < turn ? before : after;
    const double late = k == 0 ? 0.0 : force[k - 1];  // a delay of one period
    state += now.Phi * state + now.Gamma1 * late;
  }
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, 3e-7);
  for (double& each : position) each += normal(random);
  return {"record", period, {{"force", std::move(force)}, {"position", std::move(position)}}, {}};
}

Identification fit_of_lines(const Recording& recording, const Device& structure, IdentifyOptions options = {}) {
  options.scrutiny = IdentifyOptions::Scrutiny::brief;
  return identify(recording, structure, options);
}

std::vector<FindingCode> codes_of(const Trust& trust) {
  std::vector<FindingCode> codes;
  for (const Finding& each : trust.findings) codes.push_back(each.code);
  return codes;
}

TEST(DoubtedRecording, SegmentsUnderARectangularWindowLeak) {
  const Recording recording = recorded(two_bodies(), noise_force());
  IdentifyOptions options;
  EXPECT_TRUE(fit_of_lines(recording, Device(two_bodies()), options).trust.sound());
  options.response.window = Window::rectangular;
  EXPECT_THAT(codes_of(fit_of_lines(recording, Device(two_bodies()), options).trust),
              Contains(FindingCode::rectangular_window_leaks));
}

TEST(DoubtedRecording, AForceBeyondTheStructuresLimitDidNotAct) {
  DeviceParameters device = two_bodies();
  std::vector<double> force = noise_force();
  double strongest = 0.0;
  for (const double each : force) strongest = std::fmax(strongest, std::abs(each));
  const Recording recording = recorded(device, std::move(force));
  device.actuator.force_limit = 1.05 * strongest;
  EXPECT_TRUE(fit_of_lines(recording, Device(device)).trust.sound());
  device.actuator.force_limit = 0.85 * strongest;
  EXPECT_THAT(codes_of(fit_of_lines(recording, Device(device)).trust), Contains(FindingCode::force_beyond_limit));
  EXPECT_THAT(codes_of(identify_in_time(std::span(&recording, 1), Device(device)).trust),
              Contains(FindingCode::force_beyond_limit));
}

TEST(DoubtedRecording, OfRowsThatWereLeftOutTheForceBetweenIsMissing) {
  const Recording recording = recorded(two_bodies(), noise_force());
  DeviceParameters faster = two_bodies();
  faster.loop.sampling_period = 0.5 * period;
  const Trust trust = fit_of_lines(recording, Device(faster)).trust;
  EXPECT_THAT(codes_of(trust), Contains(FindingCode::rows_thinned));
  EXPECT_THAT(trust.reasons, Contains(HasSubstr("2 periods of the loop")));
  EXPECT_THAT(codes_of(identify_in_time(std::span(&recording, 1), Device(faster)).trust),
              Contains(FindingCode::rows_thinned));
  faster.loop.sampling_period = 0.7 * period;  // no log of every second or third row
  EXPECT_TRUE(fit_of_lines(recording, Device(faster)).trust.sound());
}

TEST(DoubtedRecording, APositionOfTheNextInstantHidesDelay) {
  Recording recording = recorded(two_bodies(), noise_force());
  std::vector<double>& position = recording.channels[1].samples;
  std::rotate(position.begin(), position.begin() + 1, position.end());
  position.back() = *(position.end() - 2);
  const Identification found = fit_of_lines(recording, Device(two_bodies()));
  EXPECT_GT(found.analysis.critical.stiffness, 1.3 * critical_stiffness(Device(two_bodies())).stiffness);
  EXPECT_THAT(codes_of(found.trust), Contains(FindingCode::delay_lost));
  EXPECT_THAT(codes_of(identify_in_time(std::span(&recording, 1), Device(two_bodies())).trust),
              Contains(FindingCode::delay_lost));
}

TEST(DoubtedRecording, ADampingThatFallsMidwayIsNamedWithItsSoftestLimit) {
  const double softest = critical_stiffness(Device(two_bodies())).stiffness;
  constexpr std::array shares{0.75, 0.5, 0.85};
  for (const double share : std::span(shares).first(test::by_tier(1U, 3U))) {
    const Identification found = fit_of_lines(warming_up(share, noise_force()), Device(two_bodies()));
    EXPECT_GT(found.analysis.critical.stiffness, 1.2 * softest) << share;
    EXPECT_THAT(codes_of(found.trust), Contains(FindingCode::damping_changes)) << share;
  }
  const Identification steady = fit_of_lines(warming_up(0.0, noise_force()), Device(two_bodies()));
  EXPECT_TRUE(steady.trust.sound());
  EXPECT_NEAR(steady.analysis.critical.stiffness, softest, 0.01 * softest);
}

TEST(DoubtedRecording, OfTwoForcesSaturationShowsInNothing) {
  const auto notes = [](const Recording& recording) {
    std::string all;
    for (const Remark& each : fit_of_lines(recording, Device(two_bodies())).remarks) all += each.what + "\n";
    return all;
  };
  std::vector<double> force = noise_force();
  EXPECT_THAT(notes(recorded(two_bodies(), force)), testing::Not(HasSubstr("two values only")));
  for (double& each : force) each = each > 0.0 ? 3.0 : -3.0;
  EXPECT_THAT(notes(recorded(two_bodies(), force)), HasSubstr("two values only"));
}

}  // namespace
}  // namespace zwidth::doubted_recording_test
