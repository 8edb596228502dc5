#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "lhifam.hpp"
#include "report/figure/figures.hpp"
#include "report/text/relay_text.hpp"
#include "results/relay_json.hpp"
#include "zwidth/simulation/relay.hpp"

namespace zwidth::report {
namespace {

using results::relay_csv;
using results::relay_json;

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

RelayResult simulated(DeviceParameters parameters, double start, double duration = 20.0) {
  RelayOptions options;
  options.relay.amplitude = 5.0;
  options.start_offset = start;
  options.duration = duration;
  return relay(Device(std::move(parameters)), options);
}

DeviceParameters with_friction(DeviceParameters device, double friction) {
  device.bodies.back().coulomb = friction;
  return device;
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
    const RelayResult report = simulated(device, 0.03, 1.0);
    EXPECT_EQ(relay_json(report)["remarks"].size(), 1U);
    EXPECT_THAT(relay_text(report), HasSubstr("the wall's damper and filters are left out"));
  }
}

TEST(RelayReport, JsonHoldsTheSameAndNullWhereThereIsNone) {
  const RelayResult result =
      simulated(with_friction(test::with_delay(test::reduced_pretension_parameters(), 6.25e-3), 0.4), 0.03);
  const auto json = relay_json(result);
  EXPECT_EQ(json["schema"], "zwidth.relay/1");
  EXPECT_EQ(json["source"], "simulation");
  EXPECT_TRUE(json["recording"].is_null());
  EXPECT_EQ(json["trials"].size(), 4U);
  EXPECT_DOUBLE_EQ(json["trials"][0]["result"]["stiffness"], result.trials[0].result->stiffness);
  EXPECT_TRUE(json["trials"][0]["reason"].is_null());
  EXPECT_EQ(json["predictions"]["sampled_relay"].size(), result.prediction->sampled_relay.size());
  EXPECT_DOUBLE_EQ(json["mean"]["frequency_hz"], result.mean->frequency / (2.0 * std::numbers::pi));
  EXPECT_NEAR(json["friction_level"], 0.08, 1e-12);
  EXPECT_EQ(json["limit_reading"], "unsafe");
  EXPECT_EQ(json["trust"]["verdict"], "doubtful");

  const RelayResult still = relay(
      Recording{"run.csv", 1e-3, {{"", std::vector<double>(1000, 5.0)}, {"", std::vector<double>(1000, 0.1)}}, {}});
  const auto empty = relay_json(still);
  EXPECT_EQ(empty["trials"][0]["oscillates"], false);
  EXPECT_EQ(empty["trials"][0]["reason"], "the force never changes");
  EXPECT_TRUE(empty["trials"][0]["result"].is_null());
  for (const char* key : {"mean", "predictions", "device", "delay_s"}) EXPECT_TRUE(empty[key].is_null()) << key;
  EXPECT_THAT(relay_text(still), HasSubstr("trial 1: no oscillation: the force never changes"));
  EXPECT_THAT(empty["explanation"], IsEmpty());
  EXPECT_EQ(empty["trust"]["verdict"], "refused");
}

TEST(RelayReport, CsvIsTheRecordToTheLastDigit) {
  const RelayResult report = simulated(test::with_delay(test::rigid_parameters(), 8e-3), 0.01, 0.1);
  const std::string csv = relay_csv(report);
  EXPECT_THAT(csv, ::testing::StartsWith("time_s,force_1,position_1,force_2,position_2,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 101);
  EXPECT_THAT(csv, HasSubstr(fmt::format("\n0.05,{:.17g},{:.17g},", report.trials[0].force[50],
                                         report.trials[0].position[50])));
}

TEST(RelayReport, FigureIsDrawnWithAndWithoutAnOscillation) {
  RelayResult report = simulated(test::with_delay(test::rigid_parameters(), 8e-3), 0.01);
  const std::string svg =
      draw_relay_record("A title", report.trials[0], report.sampling_period, Motion::linear, FigureFormat::svg);
  EXPECT_THAT(svg, AllOf(HasSubstr("A title"), HasSubstr("Force (N)"), HasSubstr("Position (mm)")));
  report.trials[0].result = tl::unexpected(NoOscillation{{.code = FindingCode::force_never_changes}});
  EXPECT_THAT(draw_relay_record("A title", report.trials[0], 1e-3, Motion::rotary, FigureFormat::svg),
              AllOf(HasSubstr("No oscillation: the force never changes"), HasSubstr("Force (N m)")));
}

}  // namespace
}  // namespace zwidth::report
