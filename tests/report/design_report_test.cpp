// Text, JSON, csv and figures of design questions.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "lhifam.hpp"
#include "report/figure/figures.hpp"
#include "report/json_keys.hpp"
#include "report/text/design_text.hpp"
#include "report/text/text_table.hpp"
#include "results/design_json.hpp"
#include "results/design_target_json.hpp"

namespace zwidth::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Json = results::Json;

const Device& lhifam() {
  static const Device device(test::lhifam_parameters());
  return device;
}

const Design& designed_lhifam() {
  static const Design answer = design(lhifam());
  return answer;
}

Device hopeless() { return Device(test::transfer_function_parameters({1.0}, {1.0, -8.0, 0.0}, 1.0)); }

ParameterSweep delay_sweep(SweepOptions options = {}) {
  return parameter_sweep(lhifam(), {{"loop.delay", 0.0, 8e-3, 81}}, options);
}

DesignComparison both_sensors(const User& user) {
  const Device motor(test::lhifam_parameters());
  const Device handle(test::handle_sensed(test::lhifam_parameters()));
  return compare_designs({"loop.sensed", {{"motor", motor}, {"handle", handle}}}, user);
}

TEST(DesignJson, EveryKeyIsDocumented) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/docs/design.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::set<std::string> keys;
  collect_keys(results::design_json(lhifam(), designed_lhifam()), keys);
  collect_keys(results::sweep_json(lhifam(), delay_sweep()), keys);
  collect_keys(results::comparison_json(both_sensors({0.5, 6.0, 135.0})), keys);
  const DesignTargetOptions target{.stiffness = 12e3};
  collect_keys(results::design_target_json(lhifam(), target, design_targets(lhifam(), target)), keys);
  const NotchOptions notch;
  collect_keys(results::notch_json(lhifam(), notch, design_notch(lhifam(), notch)), keys);
  EXPECT_GT(keys.size(), 30U);
  for (const std::string& key : keys) EXPECT_NE(text.find("`" + key + "`"), std::string::npos) << key;
}

TEST(DesignText, StrongestNumberFirstAndAtMost100Columns) {
  const std::string text = design_text(lhifam(), designed_lhifam());
  EXPECT_LE(width_of(text), 100U);
  EXPECT_LT(text.find("loop.sampling_period"), text.find("body.handle.damping"));
  EXPECT_LT(text.find("body.handle.damping"), text.find("link.0.stiffness"));
  EXPECT_THAT(text, HasSubstr("-13.4 %"));
  EXPECT_THAT(text, HasSubstr("link.0.stiffness below 43.88 kN/m: limited by vibration mode 1"));
}

TEST(DesignText, WithoutALimitSaysSo) {
  const Design answer = design(hopeless());
  EXPECT_THAT(design_text(hopeless(), answer), HasSubstr("No sensitivities"));
  EXPECT_TRUE(results::design_json(hopeless(), answer)["sensitivities"].empty());
  EXPECT_EQ(results::design_json(hopeless(), answer)["status"], "none_stable");
}

TEST(SweepReports, HoldEveryPoint) {
  const ParameterSweep sweep = delay_sweep({.any_user = true});
  const std::string csv = results::sweep_csv(sweep);
  EXPECT_THAT(csv, StartsWith("loop.delay,critical_stiffness,frequency_rad_s,mode,any_user_stiffness,trust\n"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 82);
  const Json json = results::sweep_json(lhifam(), sweep);
  EXPECT_EQ(json["points"].size(), 81U);
  EXPECT_EQ(json["points"][0]["critical_stiffness"].get<double>(), sweep.points[0].stiffness);
  EXPECT_THAT(sweep_text(lhifam(), sweep), HasSubstr("21 of 81 points"));
}

TEST(SweepReports, OfTwoNumbersSayWhereTheBestIs) {
  const Device device(test::lhifam_parameters());
  const ParameterSweep sweep =
      parameter_sweep(device, {{"loop.delay", 0.0, 1e-3, 2}, {"body.motor.mass", 0.3, 0.6, 3}});
  const std::string text = sweep_text(device, sweep);
  EXPECT_THAT(text, HasSubstr("2 x 3 points"));
  EXPECT_THAT(text, HasSubstr("largest K_CR 8.849 kN/m at loop.delay = 0 s, body.motor.mass = 0.3 kg"));
  EXPECT_EQ(results::sweep_csv(sweep).substr(0, 26), "loop.delay,body.motor.mass");
}

TEST(SweepReports, WithoutAnyLimitAreStillDrawn) {
  const ParameterSweep curve = parameter_sweep(hopeless(), {{"loop.delay", 0.0, 1.0, 3}}, {.crossovers = true});
  EXPECT_THAT(sweep_text(hopeless(), curve), HasSubstr("none stable"));
  EXPECT_THAT(draw_sweep(hopeless(), curve, FigureFormat::svg), HasSubstr("<svg"));
  const ParameterSweep map = parameter_sweep(hopeless(), {{"loop.delay", 0.0, 1.0, 2}, {"wall.damping", 0.0, 1.0, 2}});
  EXPECT_THAT(sweep_text(hopeless(), map), HasSubstr("no wall is stable from K = 0 at 4 points"));
  EXPECT_THAT(draw_sweep(hopeless(), map, FigureFormat::svg), HasSubstr("<svg"));
}

TEST(SweepFigure, NamesWhatIsDrawn) {
  const std::string figure =
      draw_sweep(lhifam(), delay_sweep({.any_user = true, .crossovers = true}), FigureFormat::svg);
  EXPECT_THAT(figure, HasSubstr("Delay (ms)"));
  EXPECT_THAT(figure, HasSubstr("with any passive user"));
  EXPECT_THAT(figure, HasSubstr("crossovers of vibration mode 1"));
  EXPECT_THAT(figure, Not(HasSubstr("vibration mode 2")));
}

TEST(SweepFigure, DrawsAMapOfUnevenAndFallingAxes) {
  const Device device(test::lhifam_parameters());
  const ParameterSweep sweep = parameter_sweep(
      device, {{"link.stiffness", 2e5, 2e4, 5, SweepAxis::Spacing::logarithmic}, {"loop.delay", 1e-3, 0.0, 300}});
  for (const FigureFormat format : {FigureFormat::svg, FigureFormat::png, FigureFormat::pdf}) {
    EXPECT_GT(draw_sweep(device, sweep, format).size(), 1000U);
  }
  EXPECT_THAT(draw_sweep(device, sweep, FigureFormat::svg), HasSubstr("Stiffness of the link (kN/m)"));
}

// Theory, sections 2 and 5: the motor's encoder is better in free motion, the handle's whoever holds it.
TEST(Comparison, SaysWhichIsBetterForWhom) {
  const DesignComparison comparison = both_sensors({0.5, 6.0, 135.0});
  const std::string text = comparison_text(comparison);
  EXPECT_THAT(text, HasSubstr("Free device: sensed = motor is better, 8.849 kN/m against 6.939 kN/m (+27.5 %)."));
  EXPECT_THAT(text, HasSubstr("Whoever holds it: sensed = handle is better, 6.37 kN/m against 5.776 kN/m (+10.3 %)."));
  EXPECT_LE(width_of(text), 100U);
  const Json json = results::comparison_json(comparison);
  EXPECT_EQ(json["best"]["free"], "motor");
  EXPECT_EQ(json["best"]["any_user"], "handle");
  const double held = json["designs"][0]["with_operator"]["critical_stiffness"].get<double>();
  DeviceParameters with_user = test::lhifam_parameters();
  with_user.user = {0.5, 6.0, 135.0};
  EXPECT_EQ(held, critical_stiffness(filtered_plant(Device(with_user))).stiffness);
}

TEST(Comparison, WithoutAUserHasTwoColumns) {
  const DesignComparison comparison = both_sensors({});
  EXPECT_THAT(comparison_text(comparison), HasSubstr("--operator"));
  EXPECT_TRUE(results::comparison_json(comparison)["best"]["with_operator"].is_null());
  EXPECT_TRUE(results::comparison_json(comparison)["operator"].is_null());
}

TEST(Comparison, OfEqualsSaysSo) {
  const Device device(test::lhifam_parameters());
  const DesignComparison comparison = compare_designs({"name", {{"a", device}, {"b", device}}});
  EXPECT_THAT(comparison_text(comparison), HasSubstr("name = a and name = b are as good (8.849 kN/m)."));
}

}  // namespace
}  // namespace zwidth::report
