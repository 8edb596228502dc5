// What a checkpoint keeps of a chunk's answers comes back whole, with the findings that its trust rests on.

#include "study/answer_bytes.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace zwidth::study_engine {
namespace {

BatchStiffness answers_with_findings() {
  Trust trust;
  trust.doubt({.code = FindingCode::limit_outside_band,
               .evidence = {{"frequency", 2.5, "Hz"}, {"lowest", 1.0}, {"highest", 2.0}},
               .subjects = {{"side", "above"}},
               .key = "loop.delay",
               .effect = {{"critical_stiffness", 300.0}}});
  trust.refuse({.code = FindingCode::second_route_contradicts, .evidence = {{"stiffness", 42.0}}});
  BatchStiffness answers;
  answers.stiffness = {1.0, 2.0};
  answers.trust = trust;
  answers.exceptions.push_back({1, trust, "does not converge"});
  return answers;
}

TEST(AnswerBytes, ComeBackWithTheirFindings) {
  const BatchStiffness answers = answers_with_findings();
  std::vector<char> bytes;
  write_bytes(answers, bytes);
  const std::optional<BatchStiffness> read = answers_of(bytes);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->stiffness, answers.stiffness);
  EXPECT_EQ(read->trust, answers.trust);
  ASSERT_EQ(read->exceptions.size(), 1U);
  EXPECT_EQ(read->exceptions[0].trust, answers.trust);
  EXPECT_EQ(read->exceptions[0].trust.findings[0].code, FindingCode::limit_outside_band);
}

TEST(AnswerBytes, AreNoneWhereOneIsMissing) {
  std::vector<char> bytes;
  write_bytes(answers_with_findings(), bytes);
  bytes.pop_back();
  EXPECT_FALSE(answers_of(bytes));
}

}  // namespace
}  // namespace zwidth::study_engine
