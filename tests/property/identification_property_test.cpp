// What says nothing about the device changes nothing of the answer: units, sign, origin, order, and asking again.
#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "identification/campaign/kinds.hpp"
#include "identification/campaign/recording.hpp"
#include "zwidth/identification/identification.hpp"

namespace zwidth {
namespace {

namespace campaign = test::campaign;

using Recordings = std::vector<Recording>;

Identification identified(const Recordings& recordings, const campaign::Case& made) {
  IdentifyOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  return identify(recordings, Device(made.structure), options);
}

/// One body with friction, recorded twice for 4 s.
campaign::Case rubbing_body() {
  const campaign::Kind& kind = *campaign::find_kind("friction_1_to_5_twice");
  std::uint64_t seed = 1;
  campaign::Case made = campaign::drawn_case(kind, seed);
  while (made.named != 1 || made.experiment.period < 1e-3 || made.rotary) made = campaign::drawn_case(kind, ++seed);
  made.experiment.duration = 4.0;
  made.experiment.periods = 2;
  return made;
}

/// The same recordings with their forces and positions times these, the positions from another origin.
Recordings changed(Recordings recordings, double force, double position, double origin = 0.0) {
  for (Recording& each : recordings) {
    for (double& value : each.channels[0].samples) value *= force;
    for (double& value : each.channels[1].samples) value = position * value + origin;
  }
  return recordings;
}

/// The answer is the first one, its stiffnesses in another unit, to a thousandth of its interval.
void expect_same(const Identification& found, const Identification& first, double unit = 1.0) {
  EXPECT_EQ(found.trust.verdict, first.trust.verdict);
  ASSERT_TRUE(found.analysis.interval && first.analysis.interval);
  const double near = 1e-3 * (first.analysis.interval->upper - first.analysis.interval->lower);
  EXPECT_NEAR(found.analysis.interval->lower / unit, first.analysis.interval->lower, near);
  EXPECT_NEAR(found.analysis.interval->upper / unit, first.analysis.interval->upper, near);
  EXPECT_NEAR(found.analysis.critical.stiffness / unit, first.analysis.critical.stiffness, near);
}

TEST(IdentificationProperty, UnitsSignOriginAndOrderChangeNothing) {
  const campaign::Case made = rubbing_body();
  Recordings recordings;
  for (const campaign::Rows& rows : campaign::recorded(made)) recordings.push_back(rows.recording);
  const Identification first = identified(recordings, made);
  struct Change {
    const char* what;
    double force = 1.0;
    double position = 1.0;
    double origin = 0.0;
  };
  for (const Change& each :
       {Change{"unit of force", 0.3}, Change{"unit of position", 1.0, 0.7}, Change{"larger", 7.0, 7.0},
        Change{"the other direction", -1.0, -1.0}, Change{"another origin", 1.0, 1.0, 0.25}}) {
    SCOPED_TRACE(each.what);
    expect_same(identified(changed(recordings, each.force, each.position, each.origin), made), first,
                each.force / each.position);
  }
  SCOPED_TRACE("order");
  std::swap(recordings[0], recordings[1]);
  expect_same(identified(recordings, made), first);
}

TEST(IdentificationProperty, TheSameRecordHasTheSameAnswerToTheLastDigit) {
  const campaign::Case made = rubbing_body();
  const Recordings recordings{campaign::recorded(made).front().recording};
  const Identification first = identified(recordings, made);
  const Identification again = identified(recordings, made);
  EXPECT_EQ(again.trust, first.trust);
  EXPECT_EQ(again.analysis.critical.stiffness, first.analysis.critical.stiffness);
  ASSERT_TRUE(first.analysis.interval && again.analysis.interval);
  EXPECT_EQ(again.analysis.interval->lower, first.analysis.interval->lower);
  EXPECT_EQ(again.analysis.interval->upper, first.analysis.interval->upper);
}

}  // namespace
}  // namespace zwidth
