#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "report/analysis_report.hpp"
#include "report/example_analyses.hpp"
#include "report/text/explanation.hpp"
#include "report/text/limit_rows.hpp"
#include "report/text/wall_note.hpp"

namespace zwidth::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string text_of(const AnalysedDevice& analysed) { return analysis_text({&analysed, 1}); }

std::string with_formulas(const AnalysedDevice& analysed) { return analysis_text({&analysed, 1}, {.formulas = true}); }

/// Without its line breaks, so that a sentence is found wherever it was wrapped.
std::string unwrapped(std::string text) {
  std::string joined;
  std::istringstream words(text);
  for (std::string word; words >> word;) joined += word + " ";
  return joined;
}

TEST(AnalysisText, BeginsWithTheAnswer) {
  EXPECT_THAT(
      text_of(lhifam()),
      StartsWith("LHIfAM, translational axis" + std::string(61, ' ') +
                 "sound\n"
                 "  spring alone   nobody holding   8.849 kN/m, then shakes at 6.143 Hz: the rigid body and the\n"));
}

// One question, which wall, and the answers to it side by side: of every holder, and with a damper and margins.
TEST(AnalysisText, TheFirstLinesSayWhoHolds) {
  AnalysedDevice analysed = lhifam();
  analysed.analysis.any_user = AbsoluteStabilityLimit{5776.09, 259.9, 0.0};
  analysed.analysis.limits.any_user = HolderLimit{.critical_stiffness = 5776.09, .frequency = 259.9};
  analysed.walls.emplace();
  analysed.walls->with_damper = StiffestDampedWall{187.3e3, 230.3};
  analysed.walls->with_margins.emplace();
  analysed.walls->with_margins->wall.stiffness = 4310.0;
  analysed.walls->with_margins->wall.damping = 98.1;
  analysed.walls->with_margins->wall.velocity_filter_hz = 18.5;
  const std::vector<LimitRow> rows = limit_rows(analysed);
  ASSERT_EQ(rows.size(), 4U);
  const std::vector<std::pair<std::string, std::string>> labels = {{"spring alone", "nobody holding"},
                                                                   {"", "any passive user"},
                                                                   {"with a damper", "any passive user"},
                                                                   {"with margins", "any passive user"}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].what, labels[i].first) << i;
    EXPECT_EQ(rows[i].holder, labels[i].second) << i;
  }
  EXPECT_EQ(rows[1].answer, "5.776 kN/m, worst at 41.36 Hz");
  EXPECT_EQ(rows[2].answer, "up to 187.3 kN/m with B = 230.3 N s/m");
  EXPECT_EQ(rows[3].answer, "4.31 kN/m, B = 98.1 N s/m, velocity filter 18.5 Hz");
  EXPECT_EQ(rows[3].hint, "zwidth design FILE --recommend");
  analysed.walls->with_damper = StiffestDampedWall{7000.0, 0.0};
  EXPECT_EQ(limit_rows(analysed)[2].answer, "up to 7 kN/m: no damper raises it");
  analysed.walls = WallSummary{.with_damper = {},
                               .why_no_damper = Finding{.code = FindingCode::largest_damper_unknown},
                               .with_margins = {},
                               .why_no_margins = Finding{.code = FindingCode::device_refused}};
  const std::vector<LimitRow> without = limit_rows(analysed);
  EXPECT_EQ(without[2].hint, "zwidth region FILE");
  EXPECT_EQ(without[3].answer, "left out: the device is refused");
}

TEST(AnalysisText, TheFilesUserHasARowOfItsOwn) {
  const AnalysedDevice analysed = knob_in_a_hand();
  std::vector<std::string> holders;
  for (const LimitRow& row : limit_rows(analysed)) {
    if (!row.what.empty() && row.what != "spring alone") break;
    holders.push_back(row.holder);
  }
  EXPECT_EQ(holders, (std::vector<std::string>{"nobody holding", "the file's user", "any passive user"}));
  const std::string text = unwrapped(text_of(analysed));
  EXPECT_THAT(text, HasSubstr("With nobody holding, every wall softer than 14.21 N m/rad is stable."));
  EXPECT_THAT(text, HasSubstr("With the file's user, every wall softer than 1"));
  EXPECT_THAT(text, HasSubstr("The wall of 40 N m/rad is unstable:"));
  EXPECT_THAT(text, Not(HasSubstr("stable alone")));
  EXPECT_EQ(wall_verdict(analysed.analysis), "unstable");
}

// Whose margins they are: those with nobody holding stand first, where a hand adds damping they are the lesser ones.
TEST(AnalysisText, MarginsSayWhoseTheyAre) {
  DeviceParameters parameters = knob_in_a_hand().device.parameters();
  parameters.wall.stiffness = 10.0;
  const AnalysedDevice analysed = analysed_device(Device(parameters));
  const std::vector<std::string> notes = wall_margin_notes(analysed.analysis);
  ASSERT_GT(notes.size(), 2U);
  EXPECT_THAT(notes.front(), StartsWith("with nobody holding: gain margin 3.05 dB"));
  EXPECT_THAT(notes[1], StartsWith("with the file's user: gain margin 23.2"));
  EXPECT_THAT(notes.back(), StartsWith("with any passive user: 3.05 dB"));
}

// A position that nothing holds is no instability, and a damper has its margins in B.
TEST(AnalysisText, ADamperAloneIsJudgedAsOne) {
  DeviceParameters parameters;
  parameters.motion = Motion::rotary;
  parameters.bodies = {{"rotor", 0.05, 0.01, 0.0, 0.0}};
  parameters.loop = {0, 0, 0, 1e-3, 0.0};
  parameters.wall.stiffness = 0.0;
  parameters.wall.damping = 0.5;
  const AnalysedDevice analysed = analysed_device(Device(parameters));
  const std::string text = unwrapped(text_of(analysed));
  EXPECT_THAT(text, HasSubstr("The damper of 0.5 N m s/rad alone is stable alone only:"));
  EXPECT_THAT(text, HasSubstr("unstable when the damping grows"));
  EXPECT_THAT(text, Not(HasSubstr("the stiffness grows")));
  EXPECT_EQ(wall_verdict(analysed.analysis), "stable alone only");
}

TEST(AnalysisText, NamesEveryDelayThatLimits) {
  AnalysedDevice analysed = lhifam();
  DeviceParameters parameters = analysed.device.parameters();
  parameters.loop.delay = 0.25e-3;
  parameters.actuator.time_constant = 2e-3;
  analysed.device = Device(parameters);
  analysed.analysis.critical.limit->limited_by = {Oscillator::Kind::vibration_mode, 1};
  EXPECT_THAT(unwrapped(text_of(analysed)), HasSubstr("then shakes at 6.143 Hz: vibration mode 1 (84.31 Hz, damping "
                                                      "ratio 0.0507), the sampling delay of T/2 = 500 µs, "
                                                      "the added delay of 250 µs and the actuator's lag of 2 ms "));
}

TEST(AnalysisText, ListsEveryCrossoverAndMarksTheLimit) {
  const AnalysedDevice analysed = lhifam();
  EXPECT_THAT(text_of(analysed), HasSubstr("   6.143 Hz   38.6  8.849 kN/m  rigid body  2 poles leave   <- limits\n"));
  EXPECT_THAT(text_of(analysed), Not(HasSubstr("dB")));
  const std::string text = analysis_text({&analysed, 1}, {.decibels = true});
  EXPECT_THAT(text, HasSubstr("   6.143 Hz   38.6  8.849 kN/m   78.94  rigid body  2 poles leave   <- limits\n"));
  EXPECT_THAT(text, HasSubstr("   15.82 Hz   99.4  140.4 kN/m  102.95  rigid body  2 poles return\n"));
  EXPECT_THAT(text, HasSubstr("   98.37 Hz  618.1   33.9 kN/m   90.60  mode 1      2 poles leave\n"));
  EXPECT_THAT(text, HasSubstr("     500 Hz   3142  135.2 MN/m  162.62  rigid body  1 pole leaves   Nyquist\n"));
}

TEST(AnalysisText, FormulasThatSayNothingOfTheDeviceAreForThoseWhoAsk) {
  AnalysedDevice analysed = lhifam();
  EXPECT_FALSE(q_criterion_note(analysed));
  EXPECT_TRUE(q_criterion_note(analysed, {.formulas = true}));
  analysed.analysis.q_criterion->mode_matters = true;
  EXPECT_TRUE(q_criterion_note(analysed));
  analysed.analysis.quantisation.emplace().not_met = {UnmetAssumption::flexible_links};
  EXPECT_TRUE(encoder_notes(analysed).empty());
  EXPECT_EQ(encoder_notes(analysed, {.formulas = true}).size(), 1U);
  analysed.analysis.quantisation->not_met.clear();
  EXPECT_EQ(encoder_notes(analysed).size(), 1U);
}

TEST(AnalysisText, ShortensALongListOfCrossoversToTheSoftest) {
  AnalysedDevice analysed = lhifam();
  auto& crossovers = analysed.analysis.critical.crossovers;
  for (int i = 1; i < 500; ++i) crossovers.push_back({700.0 + i, 1e9 / i, {}, 2});
  const std::string text = text_of(analysed);
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 50);
  EXPECT_THAT(text, HasSubstr("<- limits"));
  EXPECT_THAT(text, HasSubstr("2.004 MN/m"));   // 1e9 / 499, the softest that was added
  EXPECT_THAT(text, Not(HasSubstr("1 GN/m")));  // the stiffest
  EXPECT_THAT(text, HasSubstr("the 20 softest of 503; --json gives all"));
}

TEST(AnalysisText, SaysOnWhichSideTheRigidModelIs) {
  AnalysedDevice analysed = lhifam();
  EXPECT_THAT(unwrapped(text_of(analysed)), HasSubstr("7.001 kN/m, 20.9 % too low: the safe side"));
  RigidApproximation::Error& error = analysed.analysis.rigid->error;
  analysed.analysis.rigid->critical.stiffness = 2 * 8848.70869499712;
  error = RigidApproximation::Error::unsafe;
  EXPECT_THAT(unwrapped(text_of(analysed)), HasSubstr(", 100 % too high: UNSAFE"));
  analysed.analysis.rigid->critical.stiffness = 8848.70869499712;
  error = RigidApproximation::Error::none;
  EXPECT_THAT(unwrapped(text_of(analysed)), HasSubstr("the same within 0.05 %"));
  analysed.analysis.critical = undamped_paddle().analysis.critical;
  error = RigidApproximation::Error::unsafe;
  EXPECT_THAT(unwrapped(text_of(analysed)), HasSubstr("8.849 kN/m: UNSAFE, the links make it lower"));
}

TEST(AnalysisText, ExplainsTheQCriterionInTheRightDirection) {
  AnalysedDevice analysed = lhifam();
  EXPECT_THAT(unwrapped(with_formulas(analysed)),
              HasSubstr("above the rigid critical stiffness of 7.001 kN/m, but similar"));
  analysed.analysis.q_criterion = QCriterion{3000.0, true};
  EXPECT_THAT(unwrapped(with_formulas(analysed)),
              HasSubstr("not above the rigid critical stiffness of 7.001 kN/m: the vibration mode matters"));
  analysed.analysis.q_criterion = QCriterion{3e5, false};
  EXPECT_THAT(unwrapped(with_formulas(analysed)), HasSubstr("the mode hardly matters"));
}

TEST(AnalysisText, SaysWhyTheQCriterionIsSilent) {
  AnalysedDevice analysed = lhifam();
  analysed.analysis.q_criterion = QCriterion{3e5, std::nullopt};
  analysed.analysis.rigid->critical.status = StiffnessStatus::none_stable;
  EXPECT_THAT(unwrapped(with_formulas(analysed)), HasSubstr("rigid links has no finite critical stiffness to compare"));
  DeviceParameters parameters = analysed.device.parameters();
  parameters.loop.sensed = 1;
  analysed.device = Device(parameters);
  EXPECT_THAT(unwrapped(with_formulas(analysed)), HasSubstr("It says nothing about this loop"));
  EXPECT_THAT(unwrapped(with_formulas(lhifam())), Not(HasSubstr("without the virtual damper")));
  EXPECT_THAT(unwrapped(with_formulas(lhifam_with_wall())),
              HasSubstr("Q is of the device without the virtual damper. It is not compared"));
}

TEST(AnalysisText, JudgesTheWall) {
  const std::string stable = unwrapped(text_of(lhifam_with_wall()));
  EXPECT_THAT(stable,
              HasSubstr("With nobody holding and the virtual damper of 5 N s/m (velocity low-pass at 100 Hz) closed"));
  EXPECT_THAT(
      stable,
      HasSubstr("The wall of 5 kN/m and 5 N s/m is stable alone only: 56.5 % of the limit with nobody holding"));
  EXPECT_THAT(stable, HasSubstr("gain margin 6.02 dB"));
  EXPECT_THAT(stable, HasSubstr("phase margin 5.73° (0.1 rad)"));
  EXPECT_THAT(stable, HasSubstr("delay margin 1.5 ms of further delay"));
  EXPECT_THAT(stable, HasSubstr("unstable when stiffness and damping grow 2 times"));
  EXPECT_THAT(stable, HasSubstr("unstable when both are scaled down to 0.5 times"));
  const std::string unstable = unwrapped(text_of(undamped_paddle()));
  EXPECT_THAT(unstable, HasSubstr("is unstable. With nobody holding an oscillation grows by 0.03 % per sample"));
  EXPECT_THAT(unstable, Not(HasSubstr("margin")));
}

TEST(AnalysisText, NamesNoDampingThatAWallDoesNotHave) {
  AnalysedDevice spring = lhifam_with_wall();
  DeviceParameters parameters = spring.device.parameters();
  parameters.wall.damping = 0.0;
  spring.device = Device(parameters);
  spring.analysis.wall->damping = 0.0;
  const std::string text = unwrapped(text_of(spring));
  EXPECT_THAT(text, HasSubstr("The wall of 5 kN/m is stable alone only: 56.5 % of"));
  EXPECT_THAT(text, HasSubstr("unstable when the stiffness grows 2 times"));
  EXPECT_THAT(text, HasSubstr("unstable when the stiffness is scaled down to 0.5 times"));
}

TEST(AnalysisText, ACrossoverAtRestDoesNotOscillate) {
  const std::string text = unwrapped(text_of(pushed_the_wrong_way()));
  EXPECT_THAT(text, HasSubstr("1 N/m, then drifts away: the rigid body: a constant force"));
  EXPECT_THAT(text, HasSubstr("Just above, the device drifts away without oscillating"));
  EXPECT_THAT(text, HasSubstr("1 pole leaves <- limits, a real pole at rest"));
  EXPECT_THAT(text, Not(HasSubstr("oscillates")));
}

TEST(AnalysisText, ExplainsNoneStableWithItsHigherInterval) {
  const std::string text = unwrapped(text_of(undamped_paddle()));
  EXPECT_THAT(text, HasSubstr("nobody holding none: the softest walls are unstable, stiffer ones are stable"));
  EXPECT_THAT(text, HasSubstr("unstable for an arbitrarily small wall stiffness"));
  EXPECT_THAT(text, HasSubstr("Stiffnesses from 2 N m/rad to 5 N m/rad are stable."));
}

TEST(AnalysisText, ExplainsUnbounded) {
  const std::string text = unwrapped(text_of(unlimited_transfer_function()));
  EXPECT_THAT(text, HasSubstr("nobody holding unbounded: every wall is stable"));
  EXPECT_THAT(text, HasSubstr("up to Nyquist at 500 mHz: none"));
}

TEST(AnalysisText, ARefusedAnswerCountsNoCrossovers) {
  AnalysedDevice analysed = unlimited_transfer_function();
  analysed.analysis.critical.trust.refuse({.code = FindingCode::stated, .subjects = {{"reason", "its poles crowd"}}});
  analysed.analysis.critical.status = StiffnessStatus::refused;
  EXPECT_THAT(unwrapped(text_of(analysed)), Not(HasSubstr("Phase crossovers")));
}

TEST(AnalysisText, StatesWhatIsLeftOut) {
  AnalysedDevice analysed = lhifam();
  EXPECT_THAT(unwrapped(text_of(analysed)), HasSubstr("can be made unstable by a user's grasp"));
  EXPECT_THAT(unwrapped(text_of(analysed)), HasSubstr("linear: the encoder step of 3.14 µm is left out"));
  DeviceParameters parameters = analysed.device.parameters();
  parameters.user = {0.5, 6.0, 135.0};
  parameters.actuator.force_limit = 20.0;
  analysed.device = Device(parameters);
  EXPECT_THAT(unwrapped(text_of(analysed)), HasSubstr("The file's user holds handle: 0.5 kg, 6 N s/m, 135 N/m."));
  EXPECT_THAT(unwrapped(text_of(analysed)),
              HasSubstr("the encoder step of 3.14 µm and the force limit of 20 N are left out"));
}

TEST(AnalysisText, PromisesSafetyInEveryHandOnlyBelowALimit) {
  DeviceParameters parameters = lhifam().device.parameters();
  parameters.bodies.resize(1);
  parameters.links.clear();
  parameters.loop.held = 0;
  AnalysedDevice analysed{Device(parameters), lhifam().analysis};
  const auto promises = HasSubstr("is stable in every hand.");
  EXPECT_THAT(unwrapped(text_of(analysed)), Not(promises));
  for (const double none : {0.0, std::numeric_limits<double>::infinity()}) {
    analysed.analysis.any_user = AbsoluteStabilityLimit{none};
    EXPECT_THAT(unwrapped(text_of(analysed)), Not(promises));
  }
  analysed.analysis.any_user = AbsoluteStabilityLimit{5776.09, 259.9};
  EXPECT_THAT(unwrapped(text_of(analysed)), promises);
}

TEST(AnalysisText, SaysThatTheLimitForAnyUserIsNotComputed) {
  AnalysedDevice analysed = lhifam();
  DeviceParameters parameters = analysed.device.parameters();
  parameters.bodies.resize(most_bodies_for_absolute_stability + 1, parameters.bodies.back());
  for (std::size_t i = 2; i < parameters.bodies.size(); ++i) {
    parameters.bodies[i].name = std::to_string(i);
    parameters.links.push_back({i - 1, i, 79.5e3, 15.0});
  }
  analysed.device = Device(parameters);
  const std::string text = text_of(analysed);
  EXPECT_THAT(text, HasSubstr("  any passive user   not computed above 20 bodies\n"));
  EXPECT_THAT(unwrapped(text), Not(HasSubstr("allows for all of them")));
}

TEST(AnalysisText, SeveralDevicesLeadWithATable) {
  const std::vector<AnalysedDevice> devices = {lhifam(), undamped_paddle(), unlimited_transfer_function()};
  const std::string text = analysis_text(devices);
  EXPECT_THAT(
      text,
      StartsWith("     device                          nobody  any user  frequency  limited by  rigid model  wall\n"
                 "  1  LHIfAM, translational axis  8.849 kN/m         -   6.143 Hz  rigid body     -2.03 dB  -\n"
                 "  2  paddle                            none         -          -  -                  none  "
                 "unstable\n"));
  EXPECT_THAT(text, HasSubstr("\n2. paddle "));
}

TEST(AnalysisText, FitsOneHundredColumns) {
  AnalysedDevice named = lhifam_with_wall();
  DeviceParameters parameters = named.device.parameters();
  parameters.name = std::string(200, 'n');
  named.device = Device(parameters);
  const std::vector<AnalysedDevice> devices = {named, lhifam(), undamped_paddle(), unlimited_transfer_function()};
  std::string all = analysis_text(devices);
  for (const AnalysedDevice& each : devices) all += text_of(each);
  std::istringstream lines(all);
  for (std::string line; std::getline(lines, line);) {
    const auto characters = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
    EXPECT_LE(characters, 100) << line;
  }
}

}  // namespace
}  // namespace zwidth::report
