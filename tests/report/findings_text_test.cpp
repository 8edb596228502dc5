// What a fit's text says of its findings: each once, those that matter most first.

#include "report/text/findings_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "zwidth/words/finding_text.hpp"

namespace zwidth::report {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Finding unsafe(double at_most) {
  return {.code = FindingCode::data_leave_interval_open,
          .evidence = {{"factor", 1000.0 / at_most}},
          .effect = {{"critical_stiffness", at_most}}};
}

const Finding an_open_interval{.code = FindingCode::interval_open};
const Finding no_delay_margin{.code = FindingCode::delay_margin_contradicts};
const Finding a_contradiction{.code = FindingCode::second_route_contradicts, .evidence = {{"stiffness", 42.0}}};
const Remark a_note{Remark::Severity::note, "how it was done", ""};
const Remark a_warning{Remark::Severity::warning, "what is odd", ""};

/// In one line each.
std::string unwrapped(std::string text) {
  const std::string wrap = "\n    ";
  for (std::size_t at = text.find(wrap); at != std::string::npos; at = text.find(wrap))
    text.replace(at, wrap.size(), " ");
  return text;
}

TEST(FindingsText, OfASoundAnswerIsItsRemarksWarningsFirst) {
  const FindingsText found = findings_text({}, std::vector{a_note, a_warning, a_note}, ShownFindings::three);
  EXPECT_THAT(found.against, IsEmpty());
  EXPECT_EQ(found.remarks, "\nRemarks\n  ! what is odd\n  - how it was done\n");
  EXPECT_THAT(findings_text({}, {}, ShownFindings::three).remarks, IsEmpty());
}

TEST(FindingsText, ShowsThreeThenSaysHowManyMore) {
  Trust trust;
  trust.doubt(an_open_interval);
  trust.doubt(no_delay_margin);
  const std::vector remarks{a_note, a_warning};
  const FindingsText three = findings_text(trust, remarks, ShownFindings::three);
  EXPECT_THAT(three.against, HasSubstr("DOUBTFUL"));
  EXPECT_THAT(unwrapped(three.against), HasSubstr(text(an_open_interval)));
  EXPECT_THAT(unwrapped(three.against), HasSubstr(text(no_delay_margin)));
  EXPECT_EQ(three.remarks, "\nRemarks\n  ! what is odd\n  ... 1 more: add --explain\n");
  const FindingsText all = findings_text(trust, remarks, ShownFindings::all);
  EXPECT_EQ(all.against, three.against);
  EXPECT_EQ(all.remarks, "\nRemarks\n  ! what is odd\n  - how it was done\n");
}

TEST(FindingsText, PutsRefusalsFirstThenTheLowestLimit) {
  Trust trust;
  trust.doubt(an_open_interval);
  trust.doubt(no_delay_margin);
  trust.doubt(unsafe(800.0));
  trust.doubt(unsafe(500.0));
  trust.refuse(a_contradiction);
  const FindingsText found = findings_text(trust, {}, ShownFindings::three);
  EXPECT_THAT(found.against, HasSubstr("REFUSED"));
  EXPECT_EQ(found.remarks, "  ... 2 more, 2 of them against the numbers: add --explain\n");
  const std::string against = unwrapped(found.against);
  const std::size_t refusal = against.find(text(a_contradiction));
  const std::size_t lower = against.find(text(unsafe(500.0)));
  const std::size_t higher = against.find(text(unsafe(800.0)));
  ASSERT_NE(higher, std::string::npos);
  EXPECT_LT(refusal, lower);
  EXPECT_LT(lower, higher);
  EXPECT_THAT(against, Not(HasSubstr(text(no_delay_margin))));
}

}  // namespace
}  // namespace zwidth::report
