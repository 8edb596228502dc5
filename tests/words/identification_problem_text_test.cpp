// The words of what a device cannot be identified from, from codes and numbers.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "counted.hpp"
#include "zwidth/input_problem.hpp"

namespace zwidth {
namespace {

using internal::counted;

/// "what; allowed"
std::string told_of_identification(Problem problem) { return input_problem({}, std::move(problem)).str(); }

TEST(IdentificationProblemText, SaysWhatARecordLacks) {
  EXPECT_EQ(told_of_identification({.code = ProblemCode::signal_is_constant, .subjects = {{"signal", "force"}}}),
            "the force is constant: it excites nothing; a force that varies");
  EXPECT_EQ(told_of_identification({.code = ProblemCode::signal_is_constant, .subjects = {{"signal", "motion"}}}),
            "the motion is constant: nothing to measure; another column, or a stronger force");
  Problem period{.code = ProblemCode::period_without_line, .evidence = {counted("value", 300)}};
  EXPECT_EQ(told_of_identification(period),
            "the force excites no line of a period of 300 samples; leave the period out, or give the force's own");
  period.evidence.push_back(counted("repeats", 500));
  EXPECT_EQ(told_of_identification(period),
            "the force excites no line of a period of 300 samples; leave the period out, or give the force's own: it "
            "repeats every 500 samples");
}

TEST(IdentificationProblemText, SaysWhichMotionIsNotFitted) {
  Problem motion{.code = ProblemCode::motion_not_fitted};
  EXPECT_EQ(told_of_identification(motion), "fits the motion; must fit the lines where no position is recorded");
  motion.evidence = {counted("bodies", 7), counted("most", 6)};
  EXPECT_EQ(told_of_identification(motion), "fits the motion of 7 bodies; must fit the lines of more than 6");
  motion.evidence = {counted("samples", 40), counted("least", 300)};
  EXPECT_EQ(told_of_identification(motion), "fits the motion of 40 samples; must fit the lines of fewer than 300");
}

TEST(IdentificationProblemText, SaysHowALimitIsWritten) {
  const std::string form = "K=STIFFNESS, B=DAMPING, hz=FREQUENCY, of which K must be there: \"K=3, B=0, hz=40\"";
  EXPECT_EQ(told_of_identification({.code = ProblemCode::limit_without_stiffness}), "has no K; " + form);
  Problem word{.code = ProblemCode::no_number_of_limit, .subjects = {{"word", "\"stifness\""}}};
  EXPECT_EQ(told_of_identification(word), "\"stifness\" is no number of a limit; " + form);
  word.subjects.push_back({"meant", "K"});
  EXPECT_EQ(told_of_identification(word), "\"stifness\" is no number of a limit; did you mean K?");
  EXPECT_EQ(told_of_identification(
                {.code = ProblemCode::limit_part_without_value, .subjects = {{"part", "\"5\""}, {"decimal", "comma"}}}),
            "\"5\" has no =; a point as the decimal mark: \"K=3.5\"");
}

}  // namespace
}  // namespace zwidth
