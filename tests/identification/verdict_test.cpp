#include "identification/verdict/verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace zwidth::internal {
namespace {

/// A narrow answer of one record that leaves noise.
VerdictInput narrow_fit() {
  VerdictInput fit;
  fit.limit = Interval{100.0, 150.0};
  fit.omnibus = Omnibus{.p = 0.2};
  fit.records = {{"sweep.csv", 1e-3}};
  return fit;
}

RivalEstimate friction(double lower, double upper) {
  return {.code = "coulomb_friction",
          .parameter = "friction.motor",
          .unit = "N",
          .value = 0.4,
          .standard_deviation = 0.1,
          .log_likelihood_gain = 8.0,
          .stiffness_interval = Interval{lower, upper}};
}

const Subject* subject_of(const Finding& finding, std::string_view name) {
  for (const Subject& each : finding.subjects) {
    if (each.name == name) return &each;
  }
  return nullptr;
}

TEST(Verdict, IsSoundOfANarrowIntervalAndNoise) {
  const Verdict sound = verdict_of(narrow_fit());
  EXPECT_TRUE(sound.trust.sound());
  EXPECT_TRUE(sound.remarks.empty());
}

TEST(Verdict, AWideIntervalNamesTheRivalThatLeavesItOpen) {
  VerdictInput fit = narrow_fit();
  fit.limit = Interval{100.0, 151.0};
  const Trust wide = verdict_of(fit).trust;
  EXPECT_EQ(wide.verdict, Trust::Verdict::doubtful);
  ASSERT_EQ(wide.findings.size(), 1U);
  EXPECT_EQ(wide.findings[0].code, FindingCode::data_leave_interval_open);
  EXPECT_EQ(wide.findings[0].effect, (std::vector<Evidence>{{"critical_stiffness", 100.0}}));
  EXPECT_EQ(subject_of(wide.findings[0], "rival"), nullptr);

  fit.rivals = {friction(101.0, 140.0)};
  const Finding named = verdict_of(fit).trust.findings.at(0);
  ASSERT_NE(subject_of(named, "rival"), nullptr);
  EXPECT_EQ(subject_of(named, "rival")->text, "coulomb_friction");
  // A tenth of the interval is not what leaves it open.
  fit.rivals = {friction(120.0, 125.0)};
  EXPECT_EQ(subject_of(verdict_of(fit).trust.findings.at(0), "rival"), nullptr);
}

TEST(Verdict, DoubtsWhatStandsOut) {
  VerdictInput fit = narrow_fit();
  fit.omnibus = Omnibus{.p = 1e-9, .count = 300};
  const Trust outstanding = verdict_of(fit).trust;
  EXPECT_EQ(outstanding.verdict, Trust::Verdict::doubtful);
  ASSERT_EQ(outstanding.findings.size(), 1U);
  EXPECT_EQ(outstanding.findings[0].code, FindingCode::residual_stands_out);
}

// The interval is 0.41 wide by its logarithm.
TEST(Verdict, DoubtsASearchThatWasStoppedOnItsWay) {
  VerdictInput fit = narrow_fit();
  fit.last_change = 0.19;
  EXPECT_TRUE(verdict_of(fit).trust.sound());
  fit.last_change = 0.22;
  const Trust stopped = verdict_of(fit).trust;
  EXPECT_EQ(stopped.verdict, Trust::Verdict::doubtful);
  ASSERT_EQ(stopped.findings.size(), 1U);
  EXPECT_EQ(stopped.findings[0].code, FindingCode::search_stopped);
  EXPECT_EQ(stopped.findings[0].evidence.at(0).name, "moved");
  EXPECT_NEAR(stopped.findings[0].evidence.at(0).value, std::expm1(0.22), 1e-12);
}

TEST(Verdict, DoubtsLinesWhereTheMotionTellsOfNoLimit) {
  VerdictInput fit = narrow_fit();
  EXPECT_TRUE(is_explained(fit));
  fit.motion_tells_none = true;
  EXPECT_FALSE(is_explained(fit));
  const Trust doubted = verdict_of(fit).trust;
  EXPECT_EQ(doubted.verdict, Trust::Verdict::doubtful);
  ASSERT_EQ(doubted.findings.size(), 1U);
  EXPECT_EQ(doubted.findings[0].code, FindingCode::motion_tells_no_limit);
}

TEST(Verdict, RefusesWhatHasNoLimitOrContradictsItself) {
  VerdictInput fit = narrow_fit();
  fit.limit.reset();
  fit.omnibus = Omnibus{.p = 1e-9};
  const Trust undetermined = verdict_of(fit).trust;
  EXPECT_TRUE(undetermined.refused());
  ASSERT_EQ(undetermined.findings.size(), 1U);
  EXPECT_EQ(undetermined.findings[0].code, FindingCode::nothing_determined);

  fit = narrow_fit();
  fit.contradictions = {{.code = FindingCode::motion_against_force, .evidence = {{"agreement", -0.9}}}};
  const Trust turned = verdict_of(fit).trust;
  EXPECT_TRUE(turned.refused());
  EXPECT_EQ(turned.findings.at(0).code, FindingCode::motion_against_force);
}

TEST(Verdict, AGivenDelayIsADoubtWhereTheLimitHangsOnIt) {
  VerdictInput fit = narrow_fit();
  fit.delay = GivenDelay{.given = 1e-3, .shown = 2e-3, .deviation = 1e-4, .sampling_period = 1e-3, .stiffness = 80.0};
  const Trust doubted = verdict_of(fit).trust;
  ASSERT_EQ(doubted.findings.size(), 1U);
  EXPECT_EQ(doubted.findings[0].code, FindingCode::delay_contradicts_structure);
  EXPECT_EQ(doubted.findings[0].effect, (std::vector<Evidence>{{"critical_stiffness", 80.0}}));

  fit.delay->stiffness = 110.0;  // within the interval
  const Verdict noted = verdict_of(fit);
  EXPECT_TRUE(noted.trust.sound());
  ASSERT_EQ(noted.remarks.size(), 1U);
  EXPECT_EQ(noted.remarks[0].severity, Remark::Severity::warning);

  fit.delay->deviation = 3e-4;  // within 4 deviations
  EXPECT_TRUE(verdict_of(fit).remarks.empty());
}

TEST(Verdict, NotesFrictionAndALimitOutsideTheBand) {
  VerdictInput fit = narrow_fit();
  fit.rivals = {friction(100.0, 120.0)};
  fit.place = LimitPlace{.limiting = 120.0, .lowest = 1.0, .highest = 80.0};
  const Verdict noted = verdict_of(fit);
  EXPECT_TRUE(noted.trust.sound());
  ASSERT_EQ(noted.remarks.size(), 2U);
  EXPECT_EQ(noted.remarks[0].finding->code, FindingCode::dry_friction_fitted);
  EXPECT_EQ(noted.remarks[0].what, "dry friction of 0.4 +- 0.1 N on motor");
  EXPECT_EQ(noted.remarks[1].finding->code, FindingCode::limit_outside_band);
  fit.rivals[0].standard_deviation = 0.2;
  fit.place.reset();
  EXPECT_TRUE(verdict_of(fit).remarks.empty());
}

TEST(Verdict, ClippedSamplesAreADoubt) {
  VerdictInput fit = narrow_fit();
  fit.doubts_of_data = {{.code = FindingCode::clipped_for_response, .subjects = {{"channel", "F"}}}};
  EXPECT_EQ(verdict_of(fit).trust.verdict, Trust::Verdict::doubtful);
}

}  // namespace
}  // namespace zwidth::internal
