// What relay() makes of its trials: means, the verdict on their reading, trust.

#include "zwidth/simulation/relay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "simulation/simulated_devices.hpp"
#include "zwidth/error.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

RelayOptions options_of(double start, double duration = 20.0) {
  RelayOptions options;
  options.relay.amplitude = 5.0;
  options.start_offset = start;
  options.duration = duration;
  return options;
}

RelayResult simulated(DeviceParameters parameters, double start, double duration = 20.0) {
  return relay(Device(std::move(parameters)), options_of(start, duration));
}

std::vector<FindingCode> explained(const RelayResult& result) {
  std::vector<FindingCode> codes;
  for (const Finding& each : result.explanation) codes.push_back(each.code);
  return codes;
}

DeviceParameters with_friction(DeviceParameters device, double friction) {
  device.bodies.back().coulomb = friction;
  return device;
}

RelayTrial trial_of(double frequency, double stiffness) {
  RelayTrial trial;
  RelayReading result;
  result.frequency = frequency;
  result.stiffness = stiffness;
  trial.result = result;
  return trial;
}

TEST(Relay, MeanIsThatOfTheDecibels) {
  std::vector<RelayTrial> trials{trial_of(10.0, 100.0), trial_of(14.0, 10000.0), {}};
  trials.back().result = tl::unexpected(NoOscillation{{.code = FindingCode::force_never_changes}});
  const auto mean = relay_mean(trials);
  ASSERT_TRUE(mean);
  EXPECT_EQ(mean->trials, 2U);
  EXPECT_DOUBLE_EQ(mean->frequency, 12.0);
  EXPECT_NEAR(mean->stiffness, 1000.0, 1e-9);
  EXPECT_DOUBLE_EQ(mean->lowest_frequency, 10.0);
  EXPECT_DOUBLE_EQ(mean->highest_frequency, 14.0);
  trials.erase(trials.begin(), trials.begin() + 2);
  EXPECT_FALSE(relay_mean(trials));
}

Recording swinging_at(double frequency_hz, double amplitude) {
  Recording recording;
  recording.sampling_period = 1e-3;
  recording.channels = {{"force", {}}, {"position", {}}};
  for (int k = 0; k < 20000; ++k) {
    const double swing = std::sin(2.0 * std::numbers::pi * frequency_hz * 1e-3 * k);
    recording.channels[0].samples.push_back(swing > 0.0 ? -5.0 : 5.0);
    recording.channels[1].samples.push_back(amplitude * swing);
  }
  return recording;
}

// 6 Hz and 24 Hz made a mean of 15 Hz, at which nothing ever swung.
TEST(Relay, TrialsAtDifferentOscillationsHaveNoMean) {
  RelayRecordOptions options;
  for (const bool with_device : {false, true}) {
    if (with_device) options.device = Device(test::rigid_parameters());
    const RelayResult differ = relay(std::vector{swinging_at(6.0, 1e-3), swinging_at(24.0, 1e-4)}, options);
    ASSERT_TRUE(differ.trials[0].result && differ.trials[1].result);
    EXPECT_FALSE(differ.mean);
    EXPECT_TRUE(differ.trust.refused());
    EXPECT_THAT(differ.trust.reasons, Contains(AllOf(HasSubstr("settle at different oscillations"),
                                                     HasSubstr("of which there is no mean: 5.981 Hz ("),
                                                     HasSubstr(", 1 trial) and 24.05 Hz ("))));
    EXPECT_EQ(differ.limit_reading, LimitReading::none);
    EXPECT_EQ(differ.explanation.size(), with_device ? 1U : 0U);
    const RelayResult alike = relay(std::vector{swinging_at(6.0, 1e-3), swinging_at(6.2, 1e-3)}, options);
    ASSERT_TRUE(alike.mean);
    EXPECT_EQ(alike.mean->trials, 2U);
    EXPECT_FALSE(alike.trust.refused());
  }
}

// Nothing damps it against ground, so that no wall is stable: 7.89 N m/rad from rest, 0.39 from elsewhere, were sure.
TEST(Relay, WhereNoWallIsStableTheReadingIsDoubtful) {
  DeviceParameters parameters = test::lhifam_parameters();
  for (Body& body : parameters.bodies) body.damping = 0.0;
  RelayOptions options;
  options.relay.amplitude = 1.0;
  const RelayResult result = relay(Device(parameters), options);
  ASSERT_TRUE(result.mean);
  EXPECT_EQ(result.prediction->linear.status, StiffnessStatus::none_stable);
  EXPECT_EQ(result.trust.verdict, Trust::Verdict::doubtful);
  ASSERT_FALSE(result.trust.findings.empty());
  EXPECT_EQ(result.trust.findings.back().code, FindingCode::relay_without_finite_limit);
}

TEST(Relay, NeighbouringCyclesAreOneBand) {
  const auto bands = cycle_bands({{1.0, 0, 1}, {1.05, 0, 1}, {1.1, 0, 1}, {1.5, 0, 1}, {9.0, 0, 1}, {9.5, 0, 1}});
  ASSERT_EQ(bands.size(), 3U);
  EXPECT_EQ(bands[0].count, 3U);
  EXPECT_DOUBLE_EQ(bands[0].highest.frequency, 1.1);
  EXPECT_EQ(bands[1].count, 1U);
  EXPECT_DOUBLE_EQ(bands[2].lowest.frequency, 9.0);
  EXPECT_TRUE(cycle_bands({}).empty());
}

TEST(Relay, ARelayOnTheResonanceIsToldFromTheLimit) {
  const RelayResult result =
      simulated(with_friction(test::with_delay(test::reduced_pretension_parameters(), 4.25e-3), 0.4), 0.1e-3);
  std::vector<std::string> sentences;
  for (const Finding& each : result.explanation) sentences.push_back(text(each));
  EXPECT_THAT(sentences, Contains(AllOf(HasSubstr("near the phase crossover"), HasSubstr("(vibration mode 1)"))));
  EXPECT_THAT(sentences, Contains(AllOf(HasSubstr("stiffest stable wall"), HasSubstr("UNSAFE"))));
  EXPECT_THAT(sentences, Contains(HasSubstr("Coulomb friction of up to 8.0 %")));
  EXPECT_THAT(explained(result), Contains(FindingCode::reading_above_limit));
}

TEST(Relay, AFrictionlessRigidDeviceNearlyConfirmsTheLimit) {
  using enum FindingCode;
  const auto codes = explained(simulated(test::with_delay(test::rigid_parameters(), 8e-3), 0.01, 60.0));
  EXPECT_THAT(codes, Contains(AnyOf(reads_more_at_crossover, reads_less_at_crossover)));
  EXPECT_THAT(codes, Not(Contains(AnyOf(friction_leaves_no_cycle, friction_moves_cycle, friction_leaves_cycle))));
}

TEST(Relay, FrictionMovesARigidDeviceAwayFromItsCrossover) {
  const RelayResult result = simulated(with_friction(test::with_delay(test::rigid_parameters(), 8.25e-3), 0.4), 0.03);
  EXPECT_THAT(explained(result), Contains(FindingCode::oscillates_off_crossovers));
  const auto moved = std::ranges::find(result.explanation, FindingCode::friction_moves_cycle, &Finding::code);
  ASSERT_NE(moved, result.explanation.end());
  EXPECT_EQ(moved->evidence.front().name, "frequency_hz");
  EXPECT_NEAR(moved->evidence.front().value, 2.5, 0.5);
}

TEST(Relay, ReadingsThatAreNotTheLimitAreDoubtful) {
  const RelayResult above =
      simulated(with_friction(test::with_delay(test::reduced_pretension_parameters(), 4.25e-3), 0.4), 0.1e-3);
  EXPECT_EQ(above.limit_reading, LimitReading::unsafe);
  EXPECT_EQ(above.trust.verdict, Trust::Verdict::doubtful);
  ASSERT_FALSE(above.trust.findings.empty());
  EXPECT_EQ(above.trust.findings.back().code, FindingCode::relay_reads_more);
  EXPECT_EQ(above.trust.findings.back().evidence[0].value, above.mean->stiffness);
  EXPECT_EQ(above.trust.findings.back().effect[0].value, above.prediction->linear.stiffness);
  const RelayResult below = simulated(test::with_delay(test::rigid_parameters(), 8e-3), 0.01, 60.0);
  EXPECT_EQ(below.limit_reading, LimitReading::too_cautious);
  EXPECT_EQ(below.trust.verdict, Trust::Verdict::doubtful);
  ASSERT_FALSE(below.trust.findings.empty());
  EXPECT_EQ(below.trust.findings.back().code, FindingCode::relay_reads_less);
  EXPECT_EQ(below.trust.findings.back().evidence[0].value, below.mean->stiffness);
}

TEST(Relay, TheDevicesDoubtIsTheReadings) {
  DeviceParameters device = test::with_delay(test::rigid_parameters(), 8e-3);
  device.uncertainty = Uncertainty{{"body.body.mass"}, {{1e-4}}, "the mass is not determined"};
  EXPECT_THAT(simulated(device, 0.01).trust.reasons, Contains(HasSubstr("the mass is not determined")));
}

TEST(Relay, ARefusedDeviceMakesNoNumber) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.uncertainty = Uncertainty{};
  parameters.uncertainty->verdict = Trust::Verdict::refused;
  parameters.uncertainty->warning = "nothing was determined";
  RelayOptions options;
  options.relay.amplitude = 5.0;
  const RelayResult result = relay(Device(parameters), options);
  EXPECT_TRUE(result.trust.refused());
  EXPECT_EQ(result.trust.reasons.front(), "nothing was determined");
  EXPECT_TRUE(result.trials.empty());
  EXPECT_FALSE(result.mean || result.prediction);
}

TEST(Relay, NothingThatOscillatesIsRefused) {
  const RelayResult stuck = simulated(with_friction(test::rigid_parameters(), 6.0), 0.0, 2.0);
  EXPECT_TRUE(stuck.trust.refused());
  EXPECT_FALSE(stuck.mean);
  EXPECT_EQ(stuck.limit_reading, LimitReading::none);
  EXPECT_THAT(stuck.explanation, IsEmpty());
  EXPECT_NEAR(*stuck.friction_level, 1.2, 1e-12);
}

TEST(Relay, ARecordingIsReadAsItWasSimulated) {
  const Device device(with_friction(test::with_delay(test::reduced_pretension_parameters(), 6.25e-3), 0.4));
  const RelayResult ran = relay(device, options_of(0.03));
  Recording record{"run", 1e-3, {{"force", ran.trials[1].force}, {"position", ran.trials[1].position}}, {}};
  const RelayResult alone = relay(record);
  EXPECT_EQ(alone.trials.front().result->stiffness, ran.trials[1].result->stiffness);
  EXPECT_DOUBLE_EQ(alone.relay.amplitude, 5.0);
  EXPECT_FALSE(alone.prediction);
  EXPECT_EQ(alone.trust.verdict, Trust::Verdict::doubtful);
  RelayRecordOptions options;
  options.device = device;
  const RelayResult compared = relay(record, options);
  EXPECT_EQ(compared.limit_reading, LimitReading::unsafe);
  EXPECT_EQ(compared.prediction->linear.stiffness, ran.prediction->linear.stiffness);
  record.sampling_period = 2e-3;
  EXPECT_EQ(find_problem(options, record.sampling_period)->member, "device.loop.sampling_period");
  EXPECT_THROW((void)relay(record, options), Error);
}

TEST(Relay, NamesTheMemberThatIsWrong) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  DeviceParameters limited = test::rigid_parameters();
  limited.actuator.force_limit = 6.0;
  const Device device(limited);
  const auto member_of = [&device](auto&& change) {
    RelayOptions options = options_of(0.01);
    change(options);
    const auto problem = find_problem(options, device);
    EXPECT_THROW((void)relay(device, options), Error);
    return problem ? problem->member : "none";
  };
  EXPECT_FALSE(find_problem(options_of(0.01), device));
  EXPECT_EQ(member_of([](RelayOptions& options) { options.relay.amplitude = 0.0; }), "relay.amplitude");
  EXPECT_EQ(member_of([](RelayOptions& options) { options.relay.amplitude = 7.0; }), "relay.amplitude");
  RelayOptions huge = options_of(0.01);
  huge.relay.amplitude = 1e155;
  EXPECT_EQ(find_problem(huge, Device(test::rigid_parameters()))->member, "relay.amplitude");
  EXPECT_EQ(member_of([nan](RelayOptions& options) { options.relay.hysteresis = nan; }), "relay.hysteresis");
  EXPECT_EQ(member_of([](RelayOptions& options) { options.analysis.segment_length = 2; }), "analysis.segment_length");
  EXPECT_EQ(member_of([nan](RelayOptions& options) { options.start_offset = nan; }), "start_offset");
  EXPECT_EQ(member_of([](RelayOptions& options) { options.variation = 1.0; }), "variation");
  EXPECT_EQ(member_of([](RelayOptions& options) { options.trials = 0; }), "trials");
  EXPECT_EQ(member_of([](RelayOptions& options) { options.duration = 0.01; }), "duration");
}

}  // namespace
}  // namespace zwidth
