// Seeds of benchmarks/identification_campaign that were answered wrongly: simulated recordings whose truth is known, each
// with the verdict that its record allows and bounds of its interval. The suite asks the first of each finding but those
// whose records take longest; scripts/campaign asks all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "campaign.hpp"
#include "property/identified_recordings.hpp"
#include "property/random_recordings.hpp"
#include "zwidth/identification/identification.hpp"

namespace zwidth {
namespace {

enum class Answer { any, sound, doubtful };  // any: there is one

/// What the record was made with.
enum class Made {
  linear,          ///< the structure's bodies, no friction; the limit lies below the highest line
  limited_above,   ///< the same, but the limit lies above the highest line
  rubbing,         ///< the structure's bodies, and dry friction
  without_a_body,  ///< the structure has a body too few; no friction
  hidden_body,     ///< the same, and the limit lies above the highest line
};

/// Of the interval and the value, relative to the true critical stiffness.
struct Bounds {
  double lower_at_most = 1.0;
  double upper_at_least = 1.0;
  double upper_at_most = HUGE_VAL;
  double width = HUGE_VAL;  ///< upper over lower end, at most
  double value = HUGE_VAL;  ///< distance from the truth
};
constexpr Bounds safe{.upper_at_least = 0.0};  // the lower end alone

struct Seed {
  const char* what;
  std::uint64_t seed;
  Answer answer;
  std::optional<Bounds> bounds = {};
  Made made = Made::linear;
  const char* cause = "";                                                       ///< in the first reason
  std::optional<bool> friction = {};                                            ///< whether some is found
  void (*also)(const Identification&, const test::RandomRecording&) = nullptr;  ///< what else holds
};

void PrintTo(const Seed& seed, std::ostream* stream) { *stream << seed.what << ", seed " << seed.seed; }

void only_here(const Identification& found, const test::RandomRecording&) {
  EXPECT_FALSE(found.analysis.trust.sound()) << "the device itself has open numbers";
}

void below_its_value(const Identification& found, const test::RandomRecording&) {
  EXPECT_LT(found.analysis.interval->lower, found.analysis.critical.stiffness);
}

void with_its_lag(const Identification& found, const test::RandomRecording& made) {
  const auto lag = std::ranges::find(found.fit.estimates, "actuator.time_constant", &ParameterEstimate::key);
  ASSERT_NE(lag, found.fit.estimates.end());
  EXPECT_NEAR(lag->value, made.truth.actuator.time_constant, 0.25 * made.truth.actuator.time_constant);
}

void explained_by_its_lag(const Identification& found, const test::RandomRecording& made) {
  EXPECT_GT(made.truth.actuator.time_constant, 0.0);
  EXPECT_LT(found.fit.misfit.value(), 1.5);
}

void noted_without_effect(const Identification& found, const test::RandomRecording&) {
  EXPECT_TRUE(std::ranges::any_of(found.remarks, [](const Remark& each) {
    return each.severity == Remark::Severity::note && each.consequence.ends_with("within the interval");
  }));
}

constexpr Bounds holds{};
const std::array seeds{
    // Excited to 8.5 Hz: the response shows 1284 N/m at 2.8 Hz, but nothing of the damping of a mode near 31 Hz, where
    // half of the devices that the data allow are limited; the true one is, at 633 N/m.
    Seed{"ASofterCrossoverAboveTheBand", 1000299, Answer::doubtful, safe, Made::hidden_body},
    // Excited to 12 Hz; a mode near 24 Hz limits at 20.6 N/m. The record shows its damping to 51 % only, and less of it
    // than 2.5 % of the draws have makes it limit.
    Seed{"AGuessedDampingAboveTheBand", 20105, Answer::doubtful, {}, Made::limited_above, "excite higher frequencies"},
    // Three bodies excited to 21 Hz; a mode near 52 Hz limits at 8237 N/m. The record hardly tells two dampings apart.
    Seed{"ACombinationThatHardlyShows", 70320, Answer::doubtful, safe, Made::limited_above},
    // Two bodies excited to 10 Hz, whose mode near 94 Hz limits at 3402 N/m.
    Seed{"OtherNumbersExplainAsMuch", 400289, Answer::doubtful, {}, Made::limited_above},
    // 11 free numbers and 16 lines: another minimum, of residuals 18 % larger, is as good, and there a mode at 25 Hz
    // limits, as it does in truth.
    Seed{"OfFewLinesAnotherFitExplainsAsMuch", 1100457, Answer::doubtful, {}, Made::limited_above},
    // An interval narrowed within the band; beyond it the other numbers vary with the one taken as known.
    Seed{"WhatWasNarrowedStaysOpenAboveTheBand", 2000606, Answer::doubtful, {}, Made::limited_above},
    Seed{"AWideIntervalOfLinesElsewhere",
         2400743,
         Answer::doubtful,
         {},
         Made::linear,
         "noise hides the response where the crossover limits"},
    // Two bodies of three named, of which the third bends the response below its mode.
    Seed{"ALackingBodyAboveTheBand", 3400146, Answer::doubtful, {}, Made::without_a_body, "one body more"},
    Seed{"ALackingBodyAboveTheBand", 3402262, Answer::doubtful, {}, Made::without_a_body, "one body more"},

    // Residuals of 3.6 and 1.5 times the noise.
    Seed{"ResidualsBeyondTheNoise", 500431, Answer::doubtful, {}, Made::rubbing},
    Seed{"ResidualsBeyondTheNoise", 630008, Answer::doubtful, {}, Made::rubbing},
    // The linear device explains the friction as next to nothing, since it hardly moves while stuck.
    Seed{"FrictionThatShows", 500003, Answer::doubtful, {}, Made::rubbing, "", true},
    Seed{"FrictionThatShows", 500221, Answer::doubtful, {}, Made::rubbing, "", true},
    Seed{"FrictionThatShows", 500324, Answer::doubtful, {}, Made::rubbing, "", true},
    // 0.021 N, of which a fit in time finds 0.0124 +- 0.0038 N.
    Seed{"FrictionThatIsSuspected", 600200, Answer::doubtful, {}, Made::rubbing},
    // Noise to 410 Hz makes of friction a damper of 7 N s/m beside 0.4; below 41 Hz, where the device moves, it shows.
    Seed{"FrictionUnderNoise", 900783, Answer::doubtful, {}, Made::rubbing, "", true},
    // The friction test's own spread is 1.2 of the deviations that it gives: 4.0 of them are no friction.
    Seed{"NoFriction", 910064, Answer::sound, {}, Made::linear, "", false},
    // A fit with friction in time that ends in a side minimum, its friction a third of a deviation.
    Seed{"FrictionThatIsNone", 1000006, Answer::sound, {}, Made::linear, "", false},
    // All searches end in one, one of them with a friction of five deviations.
    Seed{"FrictionThatIsNone", 2064, Answer::sound, {}, Made::linear, "", false},
    // With the friction that may be there or without it the answer is the same.
    Seed{"FrictionWithoutEffect", 3200798, Answer::sound, holds, Made::linear, "", {}, noted_without_effect},
    // It shows none once the search ends at the device.
    Seed{"FrictionWithoutEffect", 3200689, Answer::sound, holds, Made::linear, "", false},
    // Its lag was found as delay.
    Seed{"FrictionAndLag", 620055, Answer::sound, holds, Made::rubbing},

    // Sweeps that pass the limit's frequency in their first second or their last.
    Seed{"AtTheEndsOfASweep", 70164, Answer::sound, Bounds{.width = 1.05}},
    Seed{"AtTheEndsOfASweep", 70126, Answer::sound, Bounds{.width = 1.05}},
    Seed{"AtTheEndsOfASweep", 70169, Answer::sound, Bounds{.width = 1.05}},
    Seed{"AtTheEndsOfASweep", 80106, Answer::sound, Bounds{.width = 1.05}},
    // What drifts from period to period leaks into all lines of a periodic response alike.
    Seed{"DriftUnderAPeriodicForce", 500276, Answer::sound, holds},
    Seed{"DriftUnderAPeriodicForce", 500349, Answer::sound, holds},
    // Covariances that were none by rounding, and too few lines for the parameters.
    Seed{"ARecordWithAnAnswerHasOne", 500337, Answer::any, {}, Made::rubbing},
    Seed{"ARecordWithAnAnswerHasOne", 500010, Answer::any, {}, Made::limited_above},
    // Numbers of which only a combination shows.
    Seed{"ACombinationThatShows", 630073, Answer::any, holds},
    // A link of 7e-66 N/m on the way, and a search that was stopped.
    Seed{"ASearchThatWasStoppedGoesOn", 3100335, Answer::sound, holds},
    Seed{"ASearchThatWasStoppedGoesOn", 3137, Answer::sound, holds},
    Seed{"ASearchThatWasStoppedGoesOn", 3117, Answer::sound, holds},
    // Draws of a link that the data hardly show contradict them; the response itself shows 139.6.
    Seed{"AnIntervalNoWiderThanTheResponseShows", 500183, Answer::sound,
         Bounds{.lower_at_most = 1.01, .upper_at_least = 0.0, .upper_at_most = 1.1}},
    // Draws along a combination that does not show leave it.
    Seed{"AnUpperEndThatTheResponseDoesNotShow", 3100379, Answer::sound, Bounds{.upper_at_most = 1.02}},
    Seed{"AnUpperEndThatTheResponseDoesNotShow", 3100549, Answer::sound, Bounds{.upper_at_most = 1.02}},
    // Three bodies fitted with two of them as one: 24 of 1333 lines stand out, 2.5 times their noise.
    Seed{"AFewLinesStandOut", 3101225, Answer::sound, holds},
    // An encoder rounds a sweep in step with it, which no scatter shows.
    Seed{"AnEncoderRoundsInStep", 3202965, Answer::sound, holds},
    Seed{"AnEncoderRoundsInStep", 3302388, Answer::sound, holds},
    Seed{"AnEncoderRoundsInStep", 3302322, Answer::sound, holds},
    Seed{"AnEncoderRoundsInStep", 3302034, Answer::sound, holds},
    Seed{"AnEncoderRoundsInStep", 3200903, Answer::sound, holds},
    // Draws of a link go below the band's own limit, to [6.6, 32] where the response shows 18.6; the fit's 1704 lies
    // within its interval where the response shows 1667.
    Seed{"WhatTheResponseShows", 3200992, Answer::sound, holds},
    Seed{"WhatTheResponseShows", 3300366, Answer::sound, holds},
    // At the ends of their 95 % intervals the numbers explain the record 2 to 380 times worse.
    Seed{"AnEndThatNoDeviceReaches", 3100449, Answer::sound, holds},
    Seed{"AnEndThatNoDeviceReaches", 3100330, Answer::sound, holds},
    // A light body on a soft spring, resonant at the lowest line, is a side minimum of two bodies that move as one in
    // the band. The lag of 910182, which hardly shows, is open.
    Seed{"ASideMinimumIsLeft", 910027, Answer::sound, Bounds{.width = 1.01}},
    Seed{"ASideMinimumIsLeft", 910182, Answer::sound, Bounds{.width = 1.03}},
    Seed{"ASideMinimumIsLeft", 920062, Answer::sound, Bounds{.width = 1.01}},
    // Along numbers that the data leave open the response does not change.
    Seed{"OpenNumbersWithoutEffect", 920001, Answer::sound, holds, Made::linear, "", {}, only_here},
    Seed{"OpenNumbersWithoutEffect", 920066, Answer::sound, holds, Made::linear, "", {}, only_here},
    // What drifts more slowly than the test's autoregression sees, and up to 1.35 % of what is left goes with some wave
    // of the position.
    Seed{"NoCogging", 3028, Answer::sound, holds},
    Seed{"NoCogging", 3030, Answer::sound, holds},
    Seed{"NoCogging", 500191, Answer::sound, holds},
    Seed{"NoCogging", 600030, Answer::sound, holds},
    // Of all devices that the data allow the fitted one has nearly the least limit.
    Seed{"TheLeastOfAllDraws", 700060, Answer::sound, holds, Made::linear, "", {}, below_its_value},
    Seed{"TheLeastOfAllDraws", 800251, Answer::sound, holds, Made::linear, "", {}, below_its_value},
    // A search that runs away without exact slopes, to a device whose motion overflows.
    Seed{"ASearchThatRanAway", 800068, Answer::sound, holds},
    // To a damping of 1e13, without deviation and interval; bounded by the response above.
    Seed{"ASearchThatRanAway", 900104, Answer::sound, Bounds{.upper_at_most = 1.01}},
    // Two bodies that move as one, held together by a damper of 1e11 N s/m.
    Seed{"ASearchThatRanAway", 3600162, Answer::sound, holds},
    // A search from the device that moves a damping of nearly nothing to where it costs much ends 1.4 % above it.
    Seed{"ASearchThatStartsAtTheDevice", 3402763, Answer::sound, Bounds{.value = 0.005}},
    // Less than the noise is left, but alike from line to line: two bodies that move as one in the band, found as one
    // with a light one on a soft spring.
    Seed{"AlikeFromLineToLine", 3502428, Answer::sound, holds},
    Seed{"AlikeFromLineToLine", 3500107, Answer::sound, holds},
    Seed{"AlikeFromLineToLine", 3502568, Answer::sound, holds},
    // Modes of 0.07 to 0.31 of an encoder's step: its rounding follows the motion where no noise dithers it.
    Seed{"AnEncodersRoundingIsNoMode", 3602034, Answer::sound, holds},
    Seed{"AnEncodersRoundingIsNoMode", 3502627, Answer::sound, holds},
    Seed{"AnEncodersRoundingIsNoMode", 3502013, Answer::sound, holds},
    // Three bodies, the second of whose modes a search once passed over: one link of 0.09 N/m, and a body too few for a
    // reason.
    Seed{"AModeThatTheFitLacks", 3108, Answer::sound, Bounds{.value = 0.003}},
    // With one body more the record is explained better; from there the search comes to the device.
    Seed{"AFurtherBodyLeadsBack", 3502038, Answer::sound, holds},
    // A search from no lag takes it for a delay.
    Seed{"ALagIsNoDelay", 3502951, Answer::sound, holds, Made::linear, "", {}, with_its_lag},
    Seed{"ALagIsNoDelay", 3500923, Answer::sound, holds, Made::linear, "", {}, with_its_lag},
    Seed{"ALagIsNoDelay", 3500299, Answer::sound, holds, Made::linear, "", {}, with_its_lag},
    // With the delay alone free the search ends where the residuals are 15 times their noise.
    Seed{"ALagThatTheDelayHid", 500182, Answer::sound, holds, Made::linear, "", {}, explained_by_its_lag},
    Seed{"ALagThatTheDelayHid", 500091, Answer::sound, holds, Made::linear, "", {}, explained_by_its_lag},
    // Where a sweep ends, and on lines of which the noise is most, the noise itself is hardly known.
    Seed{"LinesThatNoiseHides", 2000171, Answer::sound, holds},
    Seed{"LinesThatNoiseHides", 2000452, Answer::sound, holds},
};

void expect_made(const test::RandomRecording& made, Made as) {
  const bool lacks_a_body = as == Made::without_a_body || as == Made::hidden_body;
  EXPECT_EQ(made.right_structure, !lacks_a_body);
  EXPECT_EQ(made.has_friction, as == Made::rubbing);
  EXPECT_EQ(made.limiting_hz > made.highest_hz, as == Made::limited_above || as == Made::hidden_body);
}

void expect_within(const Identification& found, const Bounds& bounds, double truth) {
  ASSERT_TRUE(found.analysis.interval);
  const double lower = found.analysis.interval->lower;
  const double upper = found.analysis.interval->upper;
  EXPECT_LE(lower, bounds.lower_at_most * truth);
  EXPECT_GE(upper, bounds.upper_at_least * truth);
  EXPECT_LE(upper, bounds.upper_at_most * truth);
  EXPECT_LE(upper, bounds.width * lower);
  EXPECT_LE(std::abs(found.analysis.critical.stiffness - truth), bounds.value * truth);
}

/// Friction is looked for in time where it is asked, and of all in campaigns: it takes most of a fit.
IdentifyOptions::Scrutiny scrutiny_of(const Seed& seed) {
  using enum IdentifyOptions::Scrutiny;
  const bool asks = seed.made == Made::rubbing || seed.friction || std::string_view(seed.what).starts_with("Friction");
  return asks ? thorough : test::by_tier(brief, thorough);
}

class IdentifiedSeedProperty : public testing::TestWithParam<Seed> {};

TEST_P(IdentifiedSeedProperty, IsAnsweredAsItsRecordAllows) {
  const Seed& expected = GetParam();
  const auto made = test::random_recording(expected.seed);
  ASSERT_TRUE(made);
  SCOPED_TRACE(made->what);
  expect_made(*made, expected.made);
  const Identification found = test::identified(*made, scrutiny_of(expected));
  if (expected.answer == Answer::sound) {
    EXPECT_TRUE(found.trust.sound()) << found.trust.reasons.front();
  } else if (expected.answer == Answer::doubtful) {
    test::expect_doubtful(found, *made);
    ASSERT_FALSE(found.trust.reasons.empty());
    EXPECT_THAT(found.trust.reasons.front(), testing::HasSubstr(expected.cause));
  }
  if (expected.friction) {
    EXPECT_EQ(found.friction.has_value(), *expected.friction);
  }
  if (expected.bounds) {
    ASSERT_NO_FATAL_FAILURE(expect_within(found, *expected.bounds, made->stiffness));
  }
  if (expected.also != nullptr) expected.also(found, *made);
}

/// Findings whose every record takes the processor for more than ten seconds.
constexpr std::array<std::string_view, 8> only_in_campaigns{"AFewLinesStandOut",
                                                            "AFurtherBodyLeadsBack",
                                                            "AModeThatTheFitLacks",
                                                            "ASearchThatRanAway",
                                                            "ASearchThatStartsAtTheDevice",
                                                            "FrictionAndLag",
                                                            "FrictionThatIsNone",
                                                            "NoFriction"};

/// The first of each finding.
std::vector<Seed> seeds_of_the_suite() {
  std::vector<Seed> firsts;
  for (const Seed& each : seeds) {
    const bool takes_long = std::ranges::find(only_in_campaigns, each.what) != only_in_campaigns.end();
    const bool is_known = !firsts.empty() && std::string_view(firsts.back().what) == each.what;
    if (!takes_long && !is_known) firsts.push_back(each);
  }
  return firsts;
}

std::string name_of(const testing::TestParamInfo<Seed>& tested) {
  return tested.param.what + ("_" + std::to_string(tested.param.seed));
}

INSTANTIATE_TEST_SUITE_P(Finding, IdentifiedSeedProperty, testing::ValuesIn(seeds_of_the_suite()), name_of);
INSTANTIATE_TEST_SUITE_P(Campaign, IdentifiedSeedProperty, testing::ValuesIn(seeds), name_of);

}  // namespace
}  // namespace zwidth
