// Simulated recordings whose truth is known: an answer that is called sound is on the safe side of it. The whole
// campaign is benchmarks/identification_campaign.cpp.
#include <gtest/gtest.h>

#include <string>

#include "property/identified_recordings.hpp"
#include "property/random_recordings.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/identification.hpp"

namespace zwidth {
namespace {

using test::expect_doubtful;
using test::expect_interval_holds;
using test::expect_sound_and_right;
using test::identified;

TEST(IdentificationProperty, WhatIsCalledSoundIsSafe) {
  int sound = 0;
  int unsafe = 0;
  constexpr std::uint64_t first = 1000;
  constexpr std::uint64_t count = 24;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const auto made = test::random_recording(seed);
    if (!made || made->truth.bodies.size() > 2) continue;  // three bodies take longer than a test should
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + made->what);
    try {
      IdentifyOptions options;
      options.structure_values = IdentifyOptions::StructureValues::placeholders;
      const Identification found = identify(made->recording, Device(made->structure), options);
      if (!found.trust.sound()) continue;
      ++sound;
      // A mode far above the band leaves no trace in it; where it leaves one, the structure is not sound.
      EXPECT_TRUE(made->right_structure || found.fit.misfit.value_or(1.0) <= 2.0);
      ASSERT_TRUE(found.analysis.interval);
      EXPECT_LE(found.analysis.interval->lower, 1.1 * made->stiffness);
      if (found.analysis.interval->lower > made->stiffness) ++unsafe;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()), "") << "an error says why";
    }
  }
  EXPECT_GE(sound, 4);
  // Of some 10 answers 2.5 % are less than one; two are what chance leaves.
  EXPECT_LE(unsafe, 2);
}

// Seeds of benchmarks/identification_campaign that were answered wrongly.

// A body too few, excited to 8.5 Hz: the response shows 1284 N/m at 2.8 Hz, but nothing of the damping of a mode near
// 31 Hz, where half of the devices that the data allow are limited; the true one is, at 633 N/m. Was sound, with
// [1280, 1288].
TEST(IdentificationProperty, ASofterCrossoverAboveTheBandIsNotNarrowedAway) {
  const auto made = test::random_recording(1000299);
  ASSERT_TRUE(made && !made->right_structure);
  const Identification found = identified(*made);
  EXPECT_FALSE(found.trust.sound());
  ASSERT_TRUE(found.analysis.interval);
  EXPECT_LE(found.analysis.interval->lower, made->stiffness);
}

// Excited to 12 Hz; a mode near 24 Hz limits at 20.6 N/m. The record shows its damping to 51 % only, and less of it than 2.5 %
// of the draws have makes it limit: was sound, with [38.97, 39.17].
TEST(IdentificationProperty, AModeAboveTheBandOfWhichTheDampingIsAGuessIsDoubtful) {
  const auto made = test::random_recording(20105);
  ASSERT_TRUE(made && made->right_structure);
  ASSERT_GT(made->limiting_hz, made->highest_hz);
  const Identification found = identified(*made);
  EXPECT_FALSE(found.trust.sound());
  ASSERT_FALSE(found.trust.reasons.empty());
  EXPECT_NE(found.trust.reasons.front().find("excite higher frequencies"), std::string::npos);
  EXPECT_FALSE(found.analysis.trust.sound());
}

// Three bodies excited to 21 Hz; a mode near 52 Hz limits at 8237 N/m. Two dampings that the record hardly tells apart were
// taken for one that it does not, with the others' deviations as if it were known: was sound, with [12376, 12628].
TEST(IdentificationProperty, ACombinationThatHardlyShowsLeavesTheOthersOpen) {
  const auto made = test::random_recording(70320);
  ASSERT_TRUE(made && made->right_structure);
  ASSERT_GT(made->limiting_hz, made->highest_hz);
  const Identification found = identified(*made);
  expect_doubtful(found, *made);
  ASSERT_TRUE(found.analysis.interval);
  EXPECT_LE(found.analysis.interval->lower, made->stiffness);
}

// Sweeps that pass the limit's frequency in their first second or their last: those lines were left out, and the answer was
// doubtful for want of them. Kept with weights that begin within the record, the third is 1 % too high at its lower end.
TEST(IdentificationProperty, WhatASweepPassesNearItsEndsCounts) {
  for (const std::uint64_t seed : {70164U, 70126U, 70169U, 80106U}) {
    const auto made = test::random_recording(seed);
    ASSERT_TRUE(made && made->right_structure);
    const Identification found = identified(*made);
    ASSERT_NO_FATAL_FAILURE(expect_sound_and_right(found, *made));
    EXPECT_LT(found.analysis.interval->upper, 1.05 * found.analysis.interval->lower) << "seed " << seed;
  }
}

// Residuals of 3.6 and 1.5 times the noise: 25 and 6 % too high, called sound.
TEST(IdentificationProperty, ResidualsBeyondTheNoiseAreNeverSound) {
  for (const std::uint64_t seed : {500431U, 630008U}) {
    const auto made = test::random_recording(seed);
    ASSERT_TRUE(made && made->has_friction);
    EXPECT_FALSE(identified(*made).trust.sound()) << "seed " << seed;
  }
}

// What drifts from period to period leaks into all lines of a periodic response alike: 17 and 16 % were unexplained.
TEST(IdentificationProperty, DriftUnderAPeriodicForceIsKeptOut) {
  for (const std::uint64_t seed : {500349U, 500276U}) {
    const auto made = test::random_recording(seed);
    ASSERT_TRUE(made && made->right_structure);
    const Identification found = identified(*made);
    ASSERT_NO_FATAL_FAILURE(expect_sound_and_right(found, *made));
  }
}

// Covariances that were none by rounding, and too few lines for the parameters: an error, no answer.
TEST(IdentificationProperty, ARecordWithAnAnswerHasOne) {
  for (const std::uint64_t seed : {500337U, 500010U}) {
    const auto made = test::random_recording(seed);
    ASSERT_TRUE(made);
    EXPECT_NO_THROW(static_cast<void>(identified(*made))) << "seed " << seed;
  }
}

// Numbers of which only a combination shows were taken for known exactly: 0.4 and 0.5 % too high, in intervals of
// +- 0.04 and + 0.6 - 0.2 %.
TEST(IdentificationProperty, ACombinationThatShowsVariesAsTheDataLeaveIt) {
  const auto made = test::random_recording(630073);
  ASSERT_TRUE(made && made->right_structure && !made->has_friction);
  const Identification found = identified(*made);
  ASSERT_NO_FATAL_FAILURE(expect_interval_holds(found, made->stiffness, made->seed));
  // Was 0.6 % up, and doubtful for friction: its lag had been found as delay.
  const auto rubbing = test::random_recording(620055);
  ASSERT_TRUE(rubbing && rubbing->right_structure && rubbing->has_friction);
  const Identification sound = identified(*rubbing);
  EXPECT_TRUE(sound.trust.sound());
  ASSERT_NO_FATAL_FAILURE(expect_interval_holds(sound, rubbing->stiffness, rubbing->seed));
}

// Two bodies excited to 10 Hz, whose mode near 94 Hz limits at 3402 N/m: was sound, with [4354, 4426].
TEST(IdentificationProperty, OtherNumbersThatExplainTheRecordAsWellAreLookedFor) {
  const auto made = test::random_recording(400289);
  ASSERT_TRUE(made && made->right_structure);
  ASSERT_GT(made->limiting_hz, made->highest_hz);
  const Identification found = identified(*made);
  expect_doubtful(found, *made);
}

// A link of 7e-66 N/m on the way ended all, and a search that was stopped was not continued.
TEST(IdentificationProperty, ASearchThatWasStoppedGoesOn) { expect_sound_and_right({3137U, 3117U, 3100335U}); }

// Draws of a link that the data hardly show contradict them: [139.83, 2308] where the response itself shows 139.6.
TEST(IdentificationProperty, AnIntervalIsNoWiderThanTheResponseShows) {
  const auto made = test::random_recording(500183);
  ASSERT_TRUE(made);
  const Identification found = identified(*made);
  EXPECT_TRUE(found.trust.sound());
  ASSERT_TRUE(found.analysis.interval);
  EXPECT_LE(found.analysis.interval->upper, 1.1 * made->stiffness);
  EXPECT_LE(found.analysis.interval->lower, 1.01 * made->stiffness);
}

// Draws along a combination that does not show leave it: [234.6, 690] and [2321, 10690] where the response itself shows
// 234.6 and 2308. Only a lower end that rose was taken.
TEST(IdentificationProperty, AnUpperEndThatTheResponseDoesNotShowIsNone) {
  expect_sound_and_right({3100549U, 3100379U}, [](const Identification& found, const test::RandomRecording& made) {
    EXPECT_LE(found.analysis.interval->upper, 1.02 * made.stiffness) << "seed " << made.seed;
  });
}

// Three bodies fitted with two of them as one: 24 of 1333 lines stood out, 2.5 times their noise, the rest hid it.
TEST(IdentificationProperty, WhatStandsOutOfAFewLinesIsASideMinimumToo) {
  const auto made = test::random_recording(3101225);
  ASSERT_TRUE(made && made->right_structure && !made->has_friction);
  ASSERT_NO_FATAL_FAILURE(expect_sound_and_right(identified(*made), *made));
}

// An encoder rounds a sweep in step with it, which no scatter shows: 1.5 to 2.5 times the noise was left, at the highest
// lines 5 to 15 % of the response, and one answer was 0.7 % too low, [103.2, 105.5] where [104.9, 105.3] holds the truth.
TEST(IdentificationProperty, WhatAnEncoderRoundsInStepWithASweepIsNoMisfit) {
  expect_sound_and_right({3302388U, 3302322U, 3302034U, 3202965U, 3200903U});
}

// Draws of a link went below the band's own limit to [6.6, 32] where the response shows 18.6, and where it shows 1667 the fit's
// 1704 lay within its interval, 1.06 times it.
TEST(IdentificationProperty, WhatTheResponseShowsIsNotLeftOpen) { expect_sound_and_right({3200992U, 3300366U}); }

// At the ends of their 95 % intervals, which are those of slopes, the numbers explained the record 2 to 380 times worse: a
// mode above the band that would limit there was no doubt.
TEST(IdentificationProperty, AnEndOfAnIntervalThatNoDeviceReachesIsNoDoubt) {
  expect_sound_and_right({3100330U, 3100449U});
}

// A light body on a soft spring, resonant at the lowest line, is a side minimum of two bodies that move as one in the
// band: 28 times the noise was left, 2 % too low. 910182 was refused: nothing by itself was determined there.
TEST(IdentificationProperty, ASideMinimumIsLeft) {
  expect_sound_and_right(
      {910027U, 910182U, 920062U}, [](const Identification& found, const test::RandomRecording& made) {
        const double widest = made.seed == 910182 ? 1.03 : 1.01;  // its lag, which hardly shows, is open
        EXPECT_LE(found.analysis.interval->upper, widest * found.analysis.interval->lower) << "seed " << made.seed;
      });
}

// Along numbers that the data leave open the response does not change: what it says of the critical stiffness within the
// band does not hang on them. 0.1 and 0.25 % off within the interval, and called doubtful.
TEST(IdentificationProperty, OpenNumbersThatTheLimitDoesNotHangOnAreNoDoubt) {
  expect_sound_and_right({920001U, 920066U}, [](const Identification& found, const test::RandomRecording&) {
    EXPECT_FALSE(found.analysis.trust.sound()) << "the device itself has open numbers";
  });
}

// What drifts more slowly than the test's autoregression sees passed for cogging: bodies that drift under a chirp. In the
// others up to 1.35 % of what is left goes with some wave of the position: of 578 records four did.
TEST(IdentificationProperty, ALinearRecordShowsNoCogging) { expect_sound_and_right({3028U, 3030U, 500191U, 600030U}); }

// Of all devices that the data allow the fitted one has the least limit, or nearly: its own value was the lower end, and
// 0.01 to 0.05 % too high.
TEST(IdentificationProperty, TheLeastOfAllDrawsIsNoLowerEnd) {
  for (const std::uint64_t seed : {700060U, 800251U}) {
    const auto made = test::random_recording(seed);
    ASSERT_TRUE(made && made->right_structure);
    const Identification found = identified(*made);
    ASSERT_NO_FATAL_FAILURE(expect_sound_and_right(found, *made));
    EXPECT_LT(found.analysis.interval->lower, found.analysis.critical.stiffness) << "seed " << seed;
  }
}

// The search ran away, to a device whose motion overflows: an error of the record's sample 7421, then refused. With exact slopes
// it does not.
TEST(IdentificationProperty, ASearchThatRanAwayComesToTheDevice) {
  const auto made = test::random_recording(800068);
  ASSERT_TRUE(made && made->right_structure && !made->has_friction);
  ASSERT_NO_FATAL_FAILURE(expect_sound_and_right(identified(*made), *made));
}

// Two bodies of three named, of which the third bends the response below its mode: 961 to 1090 N/m for 999, at 1.49 times the
// noise, and 644 to 700 for 671. Both were sound.
TEST(IdentificationProperty, ABodyThatTheStructureLacksAboveTheBandIsSeen) {
  for (const std::uint64_t seed : {3402262U, 3400146U}) {
    const auto made = test::random_recording(seed);
    ASSERT_TRUE(made && !made->right_structure && !made->has_friction);
    const Identification found = identified(*made);
    expect_doubtful(found, *made);
    EXPECT_NE(found.trust.reasons.front().find("one body more"), std::string::npos) << found.trust.reasons.front();
  }
}

// A search that went on from the device moved a damping of nearly nothing to where it costs much, and ended 1.4 % above it.
TEST(IdentificationProperty, ASearchThatStartsAtTheDeviceStaysThere) {
  expect_sound_and_right({3402763U}, [](const Identification& found, const test::RandomRecording& made) {
    EXPECT_NEAR(found.analysis.critical.stiffness, made.stiffness, 0.005 * made.stiffness);
  });
}

// Less than the noise was left, but alike from line to line: two bodies that move as one in the band, found as one with a
// light one on a soft spring.
TEST(IdentificationProperty, WhatIsAlikeFromLineToLineIsNoNoise) {
  expect_sound_and_right({3500107U, 3502568U, 3502428U});
}

// Modes of 0.07 to 0.31 of an encoder's step in the record: its rounding follows the motion where no noise dithers it.
TEST(IdentificationProperty, AnEncodersRoundingIsNoMode) { expect_sound_and_right({3502627U, 3602034U, 3502013U}); }

// With one body more the record was explained better (0.97 times the noise instead of 1.07), and the answer doubtful: from there
// the search comes to the device.
TEST(IdentificationProperty, AFurtherBodyLeadsBackToTheDevice) { expect_sound_and_right({3502038U}); }

// A search from no lag took it for a delay.
TEST(IdentificationProperty, ALagIsToldFromADelay) {
  expect_sound_and_right(
      {3500923U, 3502951U, 3500299U}, [](const Identification& found, const test::RandomRecording& made) {
        const auto lag = std::ranges::find(found.fit.estimates, "actuator.time_constant", &ParameterEstimate::key);
        ASSERT_NE(lag, found.fit.estimates.end()) << "seed " << made.seed;
        const double truth = made.truth.actuator.time_constant;
        EXPECT_NEAR(lag->value, truth, 0.25 * truth) << "seed " << made.seed;
      });
}

// 11 free numbers and 16 lines: another minimum, of residuals 18 % larger, is as good, and there a mode at 25 Hz limits, as it
// does in truth. Was sound, and 2.08 times too high.
TEST(IdentificationProperty, OfFewLinesAnotherFitExplainsAsMuch) {
  const auto made = test::random_recording(1100457);
  ASSERT_TRUE(made && made->right_structure && made->limiting_hz > made->highest_hz);
  expect_doubtful(identified(*made), *made);
}

// Where the response itself shows the critical stiffness its interval is narrowed, with the least known number taken as
// known; beyond the band the others vary with it all the same. Was sound, and 58 % too high at the lower end.
TEST(IdentificationProperty, WhatWasNarrowedStaysOpenAboveTheBand) {
  const auto made = test::random_recording(2000606);
  ASSERT_TRUE(made && made->right_structure && made->limiting_hz > made->highest_hz);
  expect_doubtful(identified(*made), *made);
}

TEST(IdentificationProperty, AWideIntervalOfLinesElsewhereIsDoubtful) {  // 16 % above the truth, sound
  const auto made = test::random_recording(2400743);
  const Identification found = identified(*made);
  expect_doubtful(found, *made);
  EXPECT_NE(found.trust.reasons.front().find("noise hides the response where the crossover limits"), std::string::npos);
}

// Where a sweep ends, and on lines of which the noise is most, the noise itself is hardly known.
TEST(IdentificationProperty, LinesThatNoiseHidesAreNotHeldAgainstTheStructure) {
  expect_sound_and_right({2000171U, 2000452U});
}

// A search that ran away, to a damping of 1e13: no number had a deviation, and none an interval; was sound, 0.09 % too high.
// With exact slopes it is bounded, by the response above.
TEST(IdentificationProperty, WhatASearchRanAwayFromIsBounded) {
  expect_sound_and_right({900104U}, [](const Identification& found, const test::RandomRecording& made) {
    EXPECT_LE(found.analysis.interval->upper, 1.01 * made.stiffness);
  });
  // Two bodies that move as one, held together by a damper of 1e11 N s/m: K_CR was refused.
  expect_sound_and_right({3600162U});
}

// With the delay alone free the search ends where the residuals are 15 times their noise: the device has a lag, no delay.
TEST(IdentificationProperty, ALagThatTheDelayHidIsFound) {
  for (const std::uint64_t seed : {500182U, 500091U}) {
    const auto made = test::random_recording(seed);
    ASSERT_TRUE(made && made->right_structure && made->truth.actuator.time_constant > 0.0);
    const Identification found = identified(*made);
    ASSERT_NO_FATAL_FAILURE(expect_sound_and_right(found, *made));
    EXPECT_LT(*found.fit.misfit, 1.5) << "seed " << seed;
  }
}

}  // namespace
}  // namespace zwidth
