// How a phrase is filled in, and the sentences that have variants.

#include "words/phrase.hpp"

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "zwidth/error.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/trust.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::internal {
namespace {

/// As a doubt says it.
std::string doubt(Finding finding) {
  Trust trust;
  trust.doubt(std::move(finding));
  return trust.reasons.front();
}

TEST(Phrase, SaysTheSameOfADoubtAndOfARemark) {
  const Finding left{.code = FindingCode::residual_stands_out,
                     .evidence = {{"from", 1.25}, {"to", 2.5}},
                     .subjects = {{"source", "sweep.csv"}, {"kind", "nonlinear"}}};
  EXPECT_EQ(doubt(left),
            "the fitted device leaves more than the noise of sweep.csv, most from 1.25 to 2.5 s: what is left follows "
            "the motion, as a nonlinear force does; the critical stiffness may lie outside its interval; excite at two "
            "amplitudes, and record smaller motion");
  const Remark remark = warning(left);
  EXPECT_EQ(remark.what,
            "the fitted device leaves more than the noise of sweep.csv, most from 1.25 to 2.5 s: what is left follows "
            "the motion, as a nonlinear force does");
  EXPECT_EQ(remark.consequence, "the critical stiffness may lie outside its interval");
  EXPECT_EQ(remark.remedy, "excite at two amplitudes, and record smaller motion");
}

TEST(Phrase, IsTheOnlyOneOfItsCode) {
  for (const std::span<const Phrase> room :
       {model_phrases(), stability_phrases(), design_phrases(), study_phrases(), simulation_phrases(), rig_phrases(),
        signal_phrases(), io_phrases(), response_phrases(), identification_phrases()}) {
    ASSERT_FALSE(room.empty());
    for (const Phrase& phrase : room) {
      EXPECT_EQ(phrase.worst, worst_severity(phrase.code)) << phrase.name;
      EXPECT_EQ(phrase.name, name_of(phrase.code));
    }
  }
}

#ifndef NDEBUG
TEST(PhraseDeathTest, NothingWorseIsMadeOfAFindingThanItsCodeAllows) {
  const Finding harmless{.code = FindingCode::no_wall};
  EXPECT_EQ(note(harmless).finding->severity, Finding::Severity::note);
  EXPECT_DEATH(static_cast<void>(warning(harmless)), "worst_severity");
  Trust trust;
  EXPECT_DEATH(trust.doubt(harmless), "worst_severity");
}
#endif

TEST(Phrase, SaysWhichOfSeveralRecordingsShowsIt) {
  EXPECT_EQ(
      doubt({.code = FindingCode::clipped_for_response, .subjects = {{"channel", "F"}, {of_recording, "sweep.csv"}}}),
      "sweep.csv: F is clipped: the response is not that of a linear device; reduce the amplitude");
}

TEST(Phrase, OfWhatTheFindingLacksIsAnError) {
  EXPECT_THROW(static_cast<void>(text({.code = FindingCode::header_with_numbers})), Error);
}

TEST(Phrase, BracesInANameStayAsTheyAre) {
  EXPECT_EQ(text({.code = FindingCode::single_numbers, .subjects = {{"numbers", "{line:n} = 2"}}}),
            "single numbers: {line:n} = 2");
}

TEST(WordsOfReading, HaveTheirVariants) {
  Finding table{.code = FindingCode::text_table,
                .evidence = {counted("columns", 3), counted("first_row", 4), counted("header", 2)},
                .subjects = {{"delimiter", "\t"}, {"decimal_mark", ","}}};
  EXPECT_EQ(words_of(table).what,
            "text of 3 columns separated by tabs, decimal comma, header in line 2, rows from line 4");
  table = {.code = FindingCode::text_table,
           .evidence = {counted("columns", 1), counted("first_row", 1)},
           .subjects = {{"decimal_mark", "."}, {"names", "none"}}};
  EXPECT_EQ(words_of(table).what,
            "text of 1 column, decimal point, no header: columns have numbers from 1, rows from line 1");
  EXPECT_EQ(text({.code = FindingCode::last_line_cut_off, .evidence = {counted("line", 9)}}),
            "the last line, 9, is cut off and left out; the trace may have been saved in part");
  EXPECT_EQ(text({.code = FindingCode::last_line_cut_off,
                  .evidence = {counted("line", 9), counted("cells", 2), counted("expected", 3)},
                  .subjects = {{"document", "export"}}}),
            "the last line, 9, is cut off after 2 of 3 cells and left out; the export may have been interrupted");
}

TEST(WordsOfReading, TellLostRowsAndJitter) {
  Finding lost{.code = FindingCode::rows_lost,
               .evidence = {counted("lost", 1000),
                            counted("rows", 10000),
                            {"share", 0.1},
                            counted("gaps", 1000),
                            counted("longest", 1),
                            {"after", 0.005},
                            counted("filled", 990),
                            {"error", 0.0123},
                            {"used", 2.5}},
               .subjects = {{"place", "sample 6"}, {"from", "sample 40"}}};
  EXPECT_EQ(
      text(lost),
      "1000 of 10000 rows are lost (10 %) in 1000 gaps, the first before sample 6 (5 ms after the start), the "
      "longest of 1 row; 990 are filled in from the rows around them, which tell the first signal to 1.2 % of its "
      "size; what happened in the other gaps is not known: used is the longest stretch without such a gap alone, "
      "2.5 s from sample 40 on; log every row");
  const Finding jitter{.code = FindingCode::jitter_undecided,
                       .evidence = {{"largest", 0.3}, {"rms", 0.17}, {"delay", 0.0289}}};
  EXPECT_EQ(warning(jitter).remedy, "log the time at which a row is sampled, or state the rate");
  EXPECT_EQ(
      doubt(jitter),
      "the times are up to 30 % of a period off equal steps (rms 17 %); whether the rows or their stamps alone are "
      "off does not show in the motion: the delay is known to 0.029 periods; log the time at which a row is "
      "sampled, or state the rate");
}

TEST(WordsOfSignals, TellAForceFromAMotion) {
  EXPECT_EQ(text({.code = FindingCode::signal_clipped,
                  .evidence = {{"level", 0.1}, {"share", 0.0123}, {"first", 1.5}},
                  .subjects = {{"channel", "x"}, {"role", "motion"}}}),
            "x is clipped at 0.1: 1.2 % of its samples, first at 1.5 s; the motion beyond is lost (the sensor's range, "
            "or an end stop): the response is too small there and distorted; reduce the amplitude");
  EXPECT_EQ(text({.code = FindingCode::signal_short,
                  .evidence = {counted("samples", 0), {"duration", 0.0}},
                  .subjects = {{"channel", "F"}, {"role", "force"}}}),
            "F has only 0 samples, 0 s; there is nothing to identify");
}

TEST(WordsOfIdentification, HaveTheirVariants) {
  const auto open = [](std::vector<Evidence> evidence) {
    return doubt({.code = FindingCode::data_leave_interval_open, .evidence = std::move(evidence)});
  };
  EXPECT_EQ(open({{"factor", 2.34}}),
            "the data leave the critical stiffness open within a factor of 2.3; excite more strongly or for longer");
  EXPECT_EQ(open({{"more_than", 1000.0}}),
            "the data leave the critical stiffness open by more than a factor of 1000; excite more strongly or for "
            "longer");
  EXPECT_EQ(open({{"delay_within_ms", 0.5}}),
            "the delay is known to +-0.5 ms only: the data leave the critical stiffness open down to 0, where not even "
            "the softest wall is stable; excite more strongly or for longer, and at higher frequencies");
  EXPECT_EQ(open({}),
            "the data leave the critical stiffness open down to 0, where not even the softest wall is stable; excite "
            "more strongly or for longer");
  const Finding by_friction{.code = FindingCode::data_leave_interval_open,
                            .evidence = {{"factor", 2.0}, {"with_lower", 40.0, "N/m"}, {"with_upper", 70.0, "N/m"}},
                            .subjects = {{"rival", "coulomb_friction"}, {"parameter", "friction.motor"}}};
  EXPECT_EQ(doubt(by_friction),
            "the data leave the critical stiffness open within a factor of 2; most of it by dry friction "
            "(friction.motor), within which it is 40 N/m to 70 N/m; record at a second, larger amplitude");

  const Finding outside{.code = FindingCode::limit_outside_band,
                        .evidence = {{"frequency", 250.0}, {"lowest", 1.0}, {"highest", 100.0}},
                        .subjects = {{"side", "above"}}};
  EXPECT_EQ(doubt(outside),
            "the crossover that limits, near 250 Hz, lies above the measured band, 1 to 100 Hz: delay, lag and modes "
            "there are not in the data; excite higher frequencies");

  Finding mass{.code = FindingCode::mass_far_from_structure, .evidence = {{"ratio", 1e-3}}, .key = "body.motor.mass"};
  mass.subjects.push_back({"prefix", "milli"});
  EXPECT_EQ(doubt(mass),
            "body.motor.mass comes out 0.001 times the structure's; one of force, motion and structure is probably not "
            "in SI units; is the motion or the force in milli of its unit?");
  mass.subjects.clear();
  EXPECT_EQ(words_of(mass).remedy, "check their units");

  const Finding counts{.code = FindingCode::channel_in_counts,
                       .subjects = {{"channel", "x"}, {"role", "motion"}, {"counts", "half"}}};
  EXPECT_EQ(
      doubt(counts),
      "x holds numbers that are whole ones apart only, as an encoder counts; every number is then per count; give "
      "the metres or radians per count");
}

}  // namespace
}  // namespace zwidth::internal
