#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "report/example_analyses.hpp"
#include "report/figure/figures.hpp"
#include "report/text/simulation_text.hpp"
#include "results/simulation_json.hpp"

namespace zwidth::report {
namespace {

using results::simulation_csv;
using results::simulation_json;

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// A run as it would be, its numbers made up.
struct Example {
  Device device = lhifam_with_wall().device;
  Simulation result;
};

Example example(LoopVerdict verdict) {
  Example run;
  Simulation& result = run.result;
  result.loop.controller = wall_controller(run.device.parameters().wall);
  result.loop.initial_position = {1e-3, 2e-3};
  result.loop.initial_velocity = {0.0, -0.1};
  result.duration = 2.0;
  result.verdict = verdict;
  result.samples = 2000;
  result.final_position = -1.234e-4;
  result.peak_penetration = 1.5e-3;
  result.generated_energy = -2e-3;
  result.peak_generated_energy = 1e-6;
  result.linear.critical.stiffness = 8848.7;
  result.linear.wall_share = 5000.0 / 8848.7;
  result.linear.wall_stable = true;
  return run;
}

std::string unwrapped(const std::string& text) {
  std::string joined;
  std::istringstream words(text);
  for (std::string word; words >> word;) joined += word + " ";
  return joined;
}

std::string text_of(const Example& run) { return simulation_text(run.device, run.result); }

TEST(SimulationText, NamesSetUpVerdictAndNumbersWithUnits) {
  Example run = example(LoopVerdict::settles);
  run.result.oscillation = Oscillation{40.0, 2e-4};
  run.result.growth_rate = -0.5;
  const std::string text = unwrapped(simulation_text(run.device, run.result));
  EXPECT_THAT(text, HasSubstr("simulated 2 s, 2000 samples at 1 kHz"));
  EXPECT_THAT(text, HasSubstr("wall 5 kN/m and 5 N s/m (velocity low-pass at 100 Hz)"));
  EXPECT_THAT(text, HasSubstr("motor at 1 mm, at rest; handle at 2 mm, moving at -100 mm/s"));
  EXPECT_THAT(text, HasSubstr("SETTLES: the oscillation dies out, the envelope halves every 1.386 s; at the end 6.366 "
                              "Hz (40 rad/s), amplitude 200 µm."));
  EXPECT_THAT(text, HasSubstr("ends at -123.4 µm"));
  EXPECT_THAT(text, HasSubstr("peak penetration 1.5 mm"));
  EXPECT_THAT(text, HasSubstr("generated energy -2 mJ at the end, 1 µJ at most"));
  EXPECT_THAT(text, HasSubstr("the wall has 56.5 % of it: stable"));
  EXPECT_THAT(text, Not(HasSubstr("settled after")));
}

TEST(SimulationText, HasASentenceForEveryVerdict) {
  for (const auto& [verdict, word] : std::vector<std::pair<LoopVerdict, std::string>>{
           {LoopVerdict::settles, "SETTLES: the device comes to rest."},
           {LoopVerdict::unstable, "UNSTABLE: the motion grows threefold or more"},
           {LoopVerdict::drifts, "DRIFTS: no oscillation within the run"},
           {LoopVerdict::undecided, "UNDECIDED: "}}) {
    EXPECT_THAT(unwrapped(text_of(example(verdict))), HasSubstr(word));
  }
  for (const auto& [verdict, word] : std::vector<std::pair<LoopVerdict, std::string>>{
           {LoopVerdict::limit_cycle, "LIMIT CYCLE: "},
           {LoopVerdict::forced, "FOLLOWS THE USER: "},
           {LoopVerdict::unstable, "UNSTABLE: an oscillation grows, the envelope doubles every 346.6 ms; at the end"},
           {LoopVerdict::settles, "SETTLES to within the encoder step of 3.14 µm; what is left: 6.366 Hz"}}) {
    Example run = example(verdict);
    run.result.oscillation = Oscillation{40.0, 2e-6};
    run.result.growth_rate = 2.0;
    EXPECT_THAT(unwrapped(simulation_text(run.device, run.result)), HasSubstr(word));
  }
}

TEST(SimulationText, SaysWhatLinearAnalysisLeavesOutWhereTheTwoDiffer) {
  Example run = example(LoopVerdict::limit_cycle);
  run.result.nonlinear_parts = {NonlinearPart::coulomb_friction, NonlinearPart::quantisation_step,
                                NonlinearPart::force_limit, NonlinearPart::leaving_wall,
                                NonlinearPart::sampling_jitter};
  run.result.linear.agrees = false;
  EXPECT_THAT(unwrapped(linear_answer(run.device, run.result)),
              HasSubstr("stable. The difference to the run: linear analysis leaves out Coulomb friction, the encoder "
                        "step, the force limit, leaving the wall, sampling jitter"));
  run.result.linear.agrees = true;
  EXPECT_THAT(linear_answer(run.device, run.result), Not(HasSubstr("leaves out")));
}

TEST(SimulationText, NamesTheRippleOfTheEncoder) {
  for (const LoopVerdict verdict : {LoopVerdict::drifts, LoopVerdict::settles}) {
    Example run = example(verdict);
    run.result.encoder_chatters = true;
    run.result.quantisation_force = QuantisationForce{0.25, 2.0 * std::numbers::pi * 40.0};
    EXPECT_THAT(unwrapped(simulation_text(run.device, run.result)), HasSubstr("250 mN either way at 40 Hz"));
    EXPECT_EQ(simulation_json(run.device, run.result)["force_ripple"]["amplitude"], 0.25);
  }
}

TEST(SimulationText, RepeatsThatTheDeviceIsNotToBeTrusted) {
  Example run = example(LoopVerdict::settles);
  run.result.trust.doubt({.code = FindingCode::stated, .subjects = {{"reason", "the mass is not determined"}}});
  EXPECT_THAT(simulation_text(run.device, run.result), HasSubstr("the mass is not determined"));
  EXPECT_EQ(simulation_json(run.device, run.result)["trust"]["verdict"], "doubtful");
}

TEST(SimulationText, FitsOneHundredColumns) {
  Example run = example(LoopVerdict::unstable);
  const Remark remark{Remark::Severity::note, std::string(150, 'x') + " y", "and what it means, at some length"};
  run.result.remarks.push_back(remark);
  run.result.loop.faults = {0.1, 1e-4, 0.2, 5e-4, 7};
  run.result.loop.user_force = {UserForce::Kind::recorded, 0.0, 0.0, 0.5, std::vector<double>(10, 1.0), 1e-3};
  std::istringstream lines(simulation_text(run.device, run.result));
  for (std::string line; std::getline(lines, line);) {
    if (line.find("xxx") != std::string::npos) continue;  // a word longer than the line stays whole
    const auto characters = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
    EXPECT_LE(characters, 100) << line;
  }
}

TEST(SimulationJson, NeverHoldsNanOrInfinity) {
  Example run = example(LoopVerdict::unstable);
  run.result.final_position = std::nan("");
  run.result.generated_energy = std::numeric_limits<double>::infinity();
  run.result.oscillation = Oscillation{40.0, std::numeric_limits<double>::infinity()};
  const auto document = simulation_json(run.device, run.result);
  EXPECT_TRUE(document.at("final_position").is_null());
  EXPECT_TRUE(document.at("generated_energy").is_null());
  EXPECT_TRUE(document.at("oscillation").at("amplitude").is_null());
  EXPECT_EQ(document.at("verdict"), "unstable");
  EXPECT_EQ(document.at("linear").at("wall_stable"), true);
}

Example simulated_example() {
  Example run{lhifam().device, {}};
  SimulationOptions options;
  options.controller = ControllerOptions{.kind = ControllerOptions::Kind::wall, .stiffness = 5000.0};
  options.initial_position = {1e-3, 1e-3};
  options.duration = 0.05;
  run.result = simulate(run.device, options);
  return run;
}

TEST(SimulationCsv, QuotesNamesThatNeedIt) {
  Example run = simulated_example();
  DeviceParameters parameters = run.device.parameters();
  parameters.bodies[0].name = "motor, \"old\"";
  run.device = Device(parameters);
  EXPECT_THAT(simulation_csv(run.device, run.result),
              StartsWith("time_s,measured,command,user_force,\"motor, \"\"old\"\".position\","
                         "\"motor, \"\"old\"\".velocity\",handle.position,handle.velocity,trust\n0,"));
}

TEST(SimulationFigure, DrawsNamesThatCouldBeMistakenForMarkup) {
  Example run = simulated_example();
  DeviceParameters parameters = run.device.parameters();
  parameters.name = "a <b> & 'c' `d` {e}_f";
  parameters.bodies[0].name = "mo_tor '1'";
  run.device = Device(parameters);
  const std::string picture = draw_simulation_figure(run.device, run.result, FigureFormat::svg);
  // Not by HasSubstr: a failure would print the whole picture.
  EXPECT_NE(picture.find("a &lt;b> &amp; 'c' `d` {e}_f"), std::string::npos);
  EXPECT_NE(picture.find("mo_tor '1' (sensed)"), std::string::npos);
}

TEST(SimulationFigure, DrawsADeviceThatDoesNotMove) {
  Example run = simulated_example();
  for (auto& body : run.result.trajectory.position) std::fill(body.begin(), body.end(), 0.0);
  std::fill(run.result.trajectory.command.begin(), run.result.trajectory.command.end(), 0.0);
  EXPECT_NE(draw_simulation_figure(run.device, run.result, FigureFormat::svg).find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace zwidth::report
