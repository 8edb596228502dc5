// What matters most comes first, and each finding once.

#include "zwidth/ranked_findings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace zwidth {
namespace {

using ::testing::ElementsAre;
using enum FindingCode;
using Severity = Finding::Severity;

Finding unsafe(double at_most) {
  return {.code = data_leave_interval_open,
          .evidence = {{"factor", 1000.0 / at_most}},
          .effect = {{"critical_stiffness", at_most}}};
}

std::vector<FindingCode> codes(const std::vector<RankedFinding>& ranked) {
  std::vector<FindingCode> found;
  for (const RankedFinding& each : ranked) found.push_back(each.finding.code);
  return found;
}

TEST(RankedFindings, RefusalsComeFirstThenTheLowestLimitThenRemarks) {
  Trust trust;
  trust.doubt({.code = interval_open});
  trust.doubt(unsafe(800.0));
  trust.doubt(unsafe(500.0));
  trust.refuse({.code = second_route_contradicts, .evidence = {{"stiffness", 42.0}}});
  const std::vector remarks{note({.code = single_numbers, .subjects = {{"numbers", "T = 1"}}}), note({.code = no_wall}),
                            warning({.code = encoder_stands_still, .evidence = {{"resolution", 1e-4, "m"}}})};
  const std::vector<RankedFinding> all = most_important(trust, remarks);
  EXPECT_THAT(codes(all), ElementsAre(second_route_contradicts, data_leave_interval_open, data_leave_interval_open,
                                      interval_open, encoder_stands_still, no_wall, single_numbers));
  EXPECT_EQ(all[0].finding.severity, Severity::refusal);
  EXPECT_EQ(all[1].finding.effect[0].value, 500.0);
  EXPECT_EQ(all[4].finding.severity, Severity::warning);
  EXPECT_EQ(all[4].words.remedy, remarks[2].remedy);
  EXPECT_THAT(codes(most_important(trust, remarks, 2)),
              ElementsAre(second_route_contradicts, data_leave_interval_open));
}

TEST(RankedFindings, ARemarkOfADoubtIsLeftOut) {
  Trust trust;
  Finding finding = unsafe(500.0);
  finding.evidence.push_back({"threshold", 1.1});
  trust.doubt(finding);
  const std::vector remarks{warning(unsafe(500.0)), warning(unsafe(400.0)),
                            warning({.code = stated, .subjects = {{"reason", trust.reasons.front()}}})};
  const std::vector<RankedFinding> ranked = most_important(trust, remarks);
  ASSERT_EQ(ranked.size(), 2U);
  EXPECT_EQ(ranked[0].finding.severity, Severity::doubt);
  EXPECT_EQ(ranked[1].finding.effect[0].value, 400.0);
}

TEST(RankedFindings, WordsWithoutAFindingAreStated) {
  Trust trust{.verdict = Trust::Verdict::refused, .reasons = {"no data"}};
  const std::vector remarks{Remark{Remark::Severity::note, "a", "b", "c"}};
  const std::vector<RankedFinding> ranked = most_important(trust, remarks);
  ASSERT_EQ(ranked.size(), 2U);
  EXPECT_THAT(codes(ranked), ElementsAre(stated, stated));
  EXPECT_EQ(ranked[0].finding.severity, Severity::refusal);
  EXPECT_EQ(ranked[1].words.consequence, "b");
}

}  // namespace
}  // namespace zwidth
