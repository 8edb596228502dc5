// What of the evidence makes an answer doubtful: a critical stiffness of 1000 N/m, 950 to 1050.

#include <gtest/gtest.h>

#include <string>

#include "identification/weak_force_test.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::internal {
namespace weak_force_doubt_test {
namespace {

using Kind = WeakForceEvidence::Kind;

/// The reason; nothing where the answer stands.
std::string doubt(const WeakForceEvidence& evidence) {
  Analysis analysis;
  analysis.critical.stiffness = 1000.0;
  analysis.interval.emplace();
  analysis.interval->lower = 950.0;
  analysis.interval->upper = 1050.0;
  const auto found = doubt_of_weak_forces({&evidence, 1}, analysis, Motion::linear, "it");
  return found ? words_of(*found).what : "";
}

std::string doubt_of_mode(double ratio, double beside, double share) {
  return doubt({Kind::mode, ratio, beside, 60.0, share});
}

std::string doubt_of_link(double ratio, double beside) { return doubt({Kind::link_friction, ratio, beside}); }

TEST(WeakForceDoubt, AModeCountsWhereItIsClearAndMovesTheAnswer) {
  EXPECT_NE(doubt_of_mode(6.1, 930.0, 0.01), "");
  EXPECT_EQ(doubt_of_mode(5.9, 930.0, 0.01), "");
  EXPECT_EQ(doubt_of_mode(6.1, 945.0, 0.01), "") << "less than 1 % below the interval";
  EXPECT_EQ(doubt_of_mode(6.1, 930.0, 0.002), "") << "drift at the low end of the band";
}

TEST(WeakForceDoubt, AModeThatMovesTheAnswerFarNeedsToBeLessClear) {
  EXPECT_NE(doubt_of_mode(5.6, 850.0, 0.2), "");
  EXPECT_EQ(doubt_of_mode(5.4, 850.0, 0.2), "");
}

TEST(WeakForceDoubt, ALargeAndPlainModeCountsWhateverItMoves) {
  EXPECT_NE(doubt_of_mode(21.0, 1000.0, 0.2), "");
  EXPECT_EQ(doubt_of_mode(19.0, 1000.0, 0.2), "");
  EXPECT_EQ(doubt_of_mode(21.0, 1000.0, 0.05), "");
}

TEST(WeakForceDoubt, AShareIsInWords) {
  EXPECT_NE(doubt_of_mode(50.0, 500.0, 0.12).find("lacks, 12 % of the response there: with it"), std::string::npos);
  EXPECT_NE(doubt_of_mode(50.0, 500.0, 480.0).find("lacks, larger than the response there"), std::string::npos);
}

TEST(WeakForceDoubt, FrictionInALinkCountsInsideAWideIntervalToo) {
  EXPECT_NE(doubt_of_link(5.0, 940.0), "");
  EXPECT_EQ(doubt_of_link(5.0, 1000.0), "");
  EXPECT_EQ(doubt_of_link(4.0, 940.0), "") << "hardly told, and the link hardly limits";
  EXPECT_NE(doubt_of_link(4.0, 900.0), "");
  Analysis wide;
  wide.critical.stiffness = 1000.0;
  wide.interval.emplace();
  wide.interval->lower = 600.0;
  wide.interval->upper = 1200.0;
  const WeakForceEvidence far{Kind::link_friction, 8.0, 730.0};
  const WeakForceEvidence near{Kind::link_friction, 8.0, 950.0};
  EXPECT_TRUE(doubt_of_weak_forces({&far, 1}, wide, Motion::linear, "it"));
  EXPECT_FALSE(doubt_of_weak_forces({&near, 1}, wide, Motion::linear, "it"));
}

}  // namespace
}  // namespace weak_force_doubt_test
}  // namespace zwidth::internal
