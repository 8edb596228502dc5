#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "report/example_analyses.hpp"
#include "report/figure/simulation_figure.hpp"
#include "report/simulated_loop.hpp"
#include "report/text/simulation_text.hpp"
#include "results/simulation_csv.hpp"
#include "results/simulation_json.hpp"

namespace zwidth::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// A run as it would be, its numbers made up.
SimulatedLoop example(LoopVerdict verdict) {
  SimulatedLoop loop{lhifam_with_wall(), {}, {}, {}};
  loop.options.loop.controller = wall_controller(loop.analysed.device.parameters().wall);
  loop.options.loop.initial_position = {1e-3, 2e-3};
  loop.options.loop.initial_velocity = {0.0, -0.1};
  loop.options.duration = 2.0;
  loop.result.verdict = verdict;
  loop.result.samples = 2000;
  loop.result.final_position = -1.234e-4;
  loop.result.peak_penetration = 1.5e-3;
  loop.result.generated_energy = -2e-3;
  loop.result.peak_generated_energy = 1e-6;
  return loop;
}

std::string unwrapped(const std::string& text) {
  std::string joined;
  std::istringstream words(text);
  for (std::string word; words >> word;) joined += word + " ";
  return joined;
}

TEST(SimulationText, NamesSetUpVerdictAndNumbersWithUnits) {
  SimulatedLoop loop = example(LoopVerdict::settles);
  loop.result.oscillation = Oscillation{40.0, 2e-4};
  loop.result.growth_rate = -0.5;
  const std::string text = unwrapped(simulation_text(loop));
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
    EXPECT_THAT(unwrapped(simulation_text(example(verdict))), HasSubstr(word));
  }
  for (const auto& [verdict, word] : std::vector<std::pair<LoopVerdict, std::string>>{
           {LoopVerdict::limit_cycle, "LIMIT CYCLE: "},
           {LoopVerdict::forced, "FOLLOWS THE USER: "},
           {LoopVerdict::unstable, "UNSTABLE: an oscillation grows, the envelope doubles every 346.6 ms; at the end"},
           {LoopVerdict::settles, "SETTLES to within the encoder step of 3.14 µm; what is left: 6.366 Hz"}}) {
    SimulatedLoop loop = example(verdict);
    loop.result.oscillation = Oscillation{40.0, 2e-6};
    loop.result.growth_rate = 2.0;
    EXPECT_THAT(unwrapped(simulation_text(loop)), HasSubstr(word));
  }
}

TEST(SimulationText, SaysWhatLinearAnalysisLeavesOutWhereTheTwoDiffer) {
  SimulatedLoop loop = example(LoopVerdict::limit_cycle);
  loop.result.oscillation = Oscillation{40.0, 2e-4};
  DeviceParameters parameters = loop.analysed.device.parameters();
  parameters.bodies[0].coulomb = 0.5;
  parameters.actuator.force_limit = 10.0;
  loop.analysed.device = Device(parameters);
  loop.options.loop.controller.contact = ControllerOptions::Contact::unilateral;
  loop.options.loop.faults.sampling_jitter = 1e-4;
  EXPECT_THAT(unwrapped(linear_answer(loop)),
              HasSubstr("stable. The difference to the run: linear analysis leaves out Coulomb friction, the encoder "
                        "step, the force limit, leaving the wall, sampling jitter"));
  loop.result.verdict = LoopVerdict::settles;
  EXPECT_THAT(linear_answer(loop), Not(HasSubstr("leaves out")));
}

TEST(SimulationText, FitsOneHundredColumns) {
  SimulatedLoop loop = example(LoopVerdict::unstable);
  const Remark remark{Remark::Severity::note, std::string(150, 'x') + " y", "and what it means, at some length"};
  loop.remarks.push_back(remark);
  loop.options.loop.faults = {0.1, 1e-4, 0.2, 5e-4, 7};
  loop.options.loop.user_force = {UserForce::Kind::recorded, 0.0, 0.0, 0.5, std::vector<double>(10, 1.0), 1e-3};
  std::istringstream lines(simulation_text(loop));
  for (std::string line; std::getline(lines, line);) {
    if (line.find("xxx") != std::string::npos) continue;  // a word longer than the line stays whole
    const auto characters = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
    EXPECT_LE(characters, 100) << line;
  }
}

TEST(SimulationJson, NeverHoldsNanOrInfinity) {
  SimulatedLoop loop = example(LoopVerdict::unstable);
  loop.result.final_position = std::nan("");
  loop.result.generated_energy = std::numeric_limits<double>::infinity();
  loop.result.oscillation = Oscillation{40.0, std::numeric_limits<double>::infinity()};
  const auto document = simulation_json(loop);
  EXPECT_TRUE(document.at("final_position").is_null());
  EXPECT_TRUE(document.at("generated_energy").is_null());
  EXPECT_TRUE(document.at("oscillation").at("amplitude").is_null());
  EXPECT_EQ(document.at("verdict"), "unstable");
  EXPECT_EQ(document.at("linear").at("wall_stable"), true);
}

SimulatedLoop simulated_example() {
  SimulationOptions options;
  options.loop.controller.kind = ControllerOptions::Kind::wall;
  options.loop.controller.stiffness = 5000.0;
  options.loop.initial_position = {1e-3, 1e-3};
  options.duration = 0.05;
  return simulated_loop(lhifam(), options);
}

TEST(SimulationCsv, QuotesNamesThatNeedIt) {
  SimulatedLoop loop = simulated_example();
  DeviceParameters parameters = loop.analysed.device.parameters();
  parameters.bodies[0].name = "motor, \"old\"";
  loop.analysed.device = Device(parameters);
  EXPECT_THAT(simulation_csv(loop), StartsWith("time_s,measured,command,user_force,\"motor, \"\"old\"\".position\","
                                               "\"motor, \"\"old\"\".velocity\",handle.position,handle.velocity\n0,"));
}

TEST(SimulationFigure, DrawsNamesThatCouldBeMistakenForMarkup) {
  SimulatedLoop loop = simulated_example();
  DeviceParameters parameters = loop.analysed.device.parameters();
  parameters.name = "a <b> & 'c' `d` {e}_f";
  parameters.bodies[0].name = "mo_tor '1'";
  loop.analysed.device = Device(parameters);
  const std::string picture = draw_simulation_figure(loop, FigureFormat::svg);
  // Not by HasSubstr: a failure would print the whole picture.
  EXPECT_NE(picture.find("a &lt;b> &amp; 'c' `d` {e}_f"), std::string::npos);
  EXPECT_NE(picture.find("mo_tor '1' (sensed)"), std::string::npos);
}

TEST(SimulationFigure, DrawsADeviceThatDoesNotMove) {
  SimulatedLoop loop = simulated_example();
  for (auto& body : loop.result.trajectory.position) std::fill(body.begin(), body.end(), 0.0);
  std::fill(loop.result.trajectory.command.begin(), loop.result.trajectory.command.end(), 0.0);
  EXPECT_NE(draw_simulation_figure(loop, FigureFormat::svg).find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace zwidth::report
