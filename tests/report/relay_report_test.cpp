#include "report/relay_report.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "lhifam.hpp"
#include "report/figure/relay_figure.hpp"
#include "report/text/relay_explanation.hpp"
#include "report/text/relay_text.hpp"
#include "results/relay_csv.hpp"
#include "results/relay_json.hpp"

namespace zwidth::report {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

RelayReport simulated(DeviceParameters parameters, double start, double duration = 20.0) {
  const Device device(std::move(parameters));
  RelayReport report;
  report.relay.amplitude = 5.0;
  report.sampling_period = device.loop().sampling_period;
  RelayExperimentOptions options;
  options.relay = report.relay;
  options.start_offset = start;
  options.duration = duration;
  report.trials = relay_experiment(device, options);
  report.prediction = relay_prediction(device, report.relay);
  report.device = device;
  return report;
}

DeviceParameters with_friction(DeviceParameters device, double friction) {
  device.bodies.back().coulomb = friction;
  return device;
}

RelayTrial trial_of(double frequency, double stiffness) {
  RelayTrial trial;
  RelayResult result;
  result.frequency = frequency;
  result.stiffness = stiffness;
  trial.result = result;
  return trial;
}

TEST(RelayReport, MeanIsThatOfTheDecibels) {
  std::vector<RelayTrial> trials{trial_of(10.0, 100.0), trial_of(14.0, 10000.0), {}};
  trials.back().result = tl::unexpected(NoOscillation{"why"});
  const auto mean = mean_of(trials);
  ASSERT_TRUE(mean);
  EXPECT_EQ(mean->trials, 2U);
  EXPECT_DOUBLE_EQ(mean->frequency, 12.0);
  EXPECT_NEAR(mean->stiffness, 1000.0, 1e-9);
  EXPECT_DOUBLE_EQ(mean->lowest_frequency, 10.0);
  EXPECT_DOUBLE_EQ(mean->highest_frequency, 14.0);
  trials.erase(trials.begin(), trials.begin() + 2);
  EXPECT_FALSE(mean_of(trials));
}

TEST(RelayReport, NeighbouringCyclesAreOneBand) {
  const auto bands = cycle_bands({{1.0, 0, 1}, {1.05, 0, 1}, {1.1, 0, 1}, {1.5, 0, 1}, {9.0, 0, 1}, {9.5, 0, 1}});
  ASSERT_EQ(bands.size(), 3U);
  EXPECT_EQ(bands[0].count, 3U);
  EXPECT_DOUBLE_EQ(bands[0].highest.frequency, 1.1);
  EXPECT_EQ(bands[1].count, 1U);
  EXPECT_DOUBLE_EQ(bands[2].lowest.frequency, 9.0);
  EXPECT_TRUE(cycle_bands({}).empty());
}

TEST(RelayReport, ARelayOnTheResonanceIsToldFromTheLimit) {
  const auto sentences = relay_explanation(
      simulated(with_friction(test::with_delay(test::reduced_pretension_parameters(), 4.25e-3), 0.4), 0.1e-3));
  EXPECT_THAT(sentences, Contains(AllOf(HasSubstr("near the phase crossover"), HasSubstr("vibration mode 1"))));
  EXPECT_THAT(sentences, Contains(AllOf(HasSubstr("stiffest stable wall"), HasSubstr("UNSAFE"))));
  EXPECT_THAT(sentences, Contains(HasSubstr("Coulomb friction of up to 8.0 %")));
}

TEST(RelayReport, AFrictionlessRigidDeviceNearlyConfirmsTheLimit) {
  const auto sentences = relay_explanation(simulated(test::with_delay(test::rigid_parameters(), 8e-3), 0.01, 60.0));
  EXPECT_THAT(sentences, Contains(AllOf(HasSubstr("near the phase crossover"), HasSubstr("the rigid body"))));
  EXPECT_THAT(sentences, Not(Contains(HasSubstr("Coulomb"))));
}

TEST(RelayReport, FrictionMovesARigidDeviceAwayFromItsCrossover) {
  const auto sentences =
      relay_explanation(simulated(with_friction(test::with_delay(test::rigid_parameters(), 8.25e-3), 0.4), 0.03));
  EXPECT_THAT(sentences, Contains(HasSubstr("at no phase crossover of linear theory")));
  EXPECT_THAT(sentences, Contains(HasSubstr("moves the oscillation away from the crossover, to 2.")));
}

TEST(RelayReport, TextHasTrialsPredictionsAndMeaning) {
  const std::string text =
      relay_text(simulated(with_friction(test::with_delay(test::reduced_pretension_parameters(), 6.25e-3), 0.4), 0.03));
  for (const char* part : {"Simulated relay experiment: LHIfAM", "relay of 5 N, delay 6.25 ms", "mean",
                           "What theory expects", "first harmonics, with friction", "sampled relay, exact",
                           "continuous relay, exact", "<- critical", "What it means", "UNSAFE", "0.1221 Hz apart"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST(RelayReport, SaysThatTheWallIsLeftOut) {
  EXPECT_THAT(relay_json(simulated(test::reduced_pretension_parameters(), 0.03, 1.0))["remarks"], IsEmpty());
  DeviceParameters damped = test::reduced_pretension_parameters();
  damped.wall.damping = 5.0;
  DeviceParameters filtered = test::reduced_pretension_parameters();
  filtered.wall.filters = {{WallFilter::Kind::low_pass, 300.0}};
  for (const DeviceParameters& device : {damped, filtered}) {
    const RelayReport report = simulated(device, 0.03, 1.0);
    EXPECT_EQ(relay_json(report)["remarks"].size(), 1U);
    EXPECT_THAT(relay_text(report), HasSubstr("the wall's damper and filters are left out"));
  }
}

TEST(RelayReport, JsonHoldsTheSameAndNullWhereThereIsNone) {
  RelayReport report =
      simulated(with_friction(test::with_delay(test::reduced_pretension_parameters(), 6.25e-3), 0.4), 0.03);
  const auto json = relay_json(report);
  EXPECT_EQ(json["schema"], "zwidth.relay/1");
  EXPECT_EQ(json["source"], "simulation");
  EXPECT_TRUE(json["recording"].is_null());
  EXPECT_EQ(json["trials"].size(), 4U);
  EXPECT_DOUBLE_EQ(json["trials"][0]["result"]["stiffness"], report.trials[0].result->stiffness);
  EXPECT_TRUE(json["trials"][0]["reason"].is_null());
  EXPECT_EQ(json["predictions"]["sampled_relay"].size(), report.prediction->sampled_relay.size());
  EXPECT_DOUBLE_EQ(json["mean"]["frequency_hz"], mean_of(report.trials)->frequency / (2.0 * std::numbers::pi));
  EXPECT_NEAR(json["friction_level"], 0.08, 1e-12);

  report.trials.assign(1, {});
  report.trials[0].result = tl::unexpected(NoOscillation{"the force never changes"});
  report.prediction.reset();
  report.device.reset();
  report.source = RelayReport::Source::recording;
  report.recording = "run.csv";
  const auto empty = relay_json(report);
  EXPECT_EQ(empty["trials"][0]["oscillates"], false);
  EXPECT_EQ(empty["trials"][0]["reason"], "the force never changes");
  EXPECT_TRUE(empty["trials"][0]["result"].is_null());
  for (const char* key : {"mean", "predictions", "device", "delay_s"}) EXPECT_TRUE(empty[key].is_null()) << key;
  EXPECT_THAT(relay_text(report), HasSubstr("trial 1: no oscillation: the force never changes"));
  EXPECT_THAT(relay_explanation(report), IsEmpty());
}

TEST(RelayReport, CsvIsTheRecordToTheLastDigit) {
  const RelayReport report = simulated(test::with_delay(test::rigid_parameters(), 8e-3), 0.01, 0.1);
  const std::string csv = relay_csv(report);
  EXPECT_THAT(csv, ::testing::StartsWith("time_s,force_1,position_1,force_2,position_2,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 101);
  EXPECT_THAT(csv, HasSubstr(fmt::format("\n0.05,{:.17g},{:.17g},", report.trials[0].force[50],
                                         report.trials[0].position[50])));
}

TEST(RelayReport, FigureIsDrawnWithAndWithoutAnOscillation) {
  RelayReport report = simulated(test::with_delay(test::rigid_parameters(), 8e-3), 0.01);
  const std::string svg =
      draw_relay_record("A title", report.trials[0], report.sampling_period, Motion::linear, FigureFormat::svg);
  EXPECT_THAT(svg, AllOf(HasSubstr("A title"), HasSubstr("Force (N)"), HasSubstr("Position (mm)")));
  report.trials[0].result = tl::unexpected(NoOscillation{"the reason"});
  EXPECT_THAT(draw_relay_record("A title", report.trials[0], 1e-3, Motion::rotary, FigureFormat::svg),
              AllOf(HasSubstr("No oscillation: the reason"), HasSubstr("Force (N m)")));
}

}  // namespace
}  // namespace zwidth::report
