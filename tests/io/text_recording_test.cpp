#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "io/recording_folder.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
namespace {

using Samples = std::vector<double>;

struct Written {
  const char* how;
  std::string text;
};

// The same three rows in the ways that loggers and spreadsheets write them.
class WrittenEitherWay : public TextRecording, public testing::WithParamInterface<Written> {};

TEST_P(WrittenEitherWay, ReadsTheSame) {
  const auto recording = read(GetParam().text, columns_named({"x", "F"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_NEAR(recording->sampling_period, 0.001, 1e-15);
  ASSERT_EQ(recording->channels.size(), 2U);
  EXPECT_EQ(recording->channels[0].samples, (Samples{0.25, -0.5, 1.5e-3}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{1.5, -2.5, 3.0}));
  EXPECT_TRUE(mentions(recording->remarks, "text of 3 columns"));
  EXPECT_TRUE(mentions(recording->remarks, "rate 1000 Hz"));
  EXPECT_EQ(warnings_in(recording->remarks), 0U);
}

INSTANTIATE_TEST_SUITE_P(
    Texts, WrittenEitherWay,
    testing::Values(
        Written{"Commas", "t,F,x\n0,1.5,0.25\n0.001,-2.5,-0.5\n0.002,3.0,1.5e-3\n"},
        Written{"CommasAndBlanks", "t, F, x\n0, 1.5, 0.25\n0.001, -2.5, -0.5\n0.002, 3, 1.5E-03\n"},
        Written{"SemicolonsAndDecimalCommas", "t;F;x\n0;1,5;0,25\n0,001;-2,5;-0,5\n0,002;3,0;1,5e-3\n"},
        Written{"SemicolonsAndPoints", "t;F;x\n0;1.5;0.25\n0.001;-2.5;-0.5\n0.002;3.0;1.5e-3\n"},
        Written{"Tabs", "t\tF\tx\n0\t1.5\t0.25\n0.001\t-2.5\t-0.5\n0.002\t3.0\t1.5e-3\n"},
        Written{"TabsAndDecimalCommas", "t\tF\tx\n0\t1,5\t0,25\n0,001\t-2,5\t-0,5\n0,002\t3,0\t1,5e-3\n"},
        Written{"AlignedBlanks",
                "    t      F        x\n    0    1.5     0.25\n0.001   -2.5     -0.5\n0.002      3  1.5e-3  \n"},
        Written{"BlanksAndDecimalCommas", "t F x\n0 1,5 0,25\n0,001 -2,5 -0,5\n0,002 3,0 1,5e-3\n"},
        Written{"CarriageReturns", "t,F,x\r\n0,1.5,0.25\r\n0.001,-2.5,-0.5\r\n0.002,3.0,1.5e-3\r\n"},
        Written{"NoLastLineEnd", "t,F,x\n0,1.5,0.25\n0.001,-2.5,-0.5\n0.002,3.0,1.5e-3"},
        Written{"ByteOrderMark", "\xEF\xBB\xBFt,F,x\n0,1.5,0.25\n0.001,-2.5,-0.5\n0.002,3.0,1.5e-3\n"},
        Written{"DelimiterAtTheEnd", "t;F;x;\n0;1.5;0.25;\n0.001;-2.5;-0.5;\n0.002;3.0;1.5e-3;\n"},
        Written{"DelimiterAtTheEndOfRowsOnly", "t,F,x\n0,1.5,0.25,\n0.001,-2.5,-0.5,\n0.002,3.0,1.5e-3,\n"},
        Written{"Comments",
                "# logged today\n% by a rig\nt,F,x\n0,1.5,0.25\n  # pause\n0.001,-2.5,-0.5\n0.002,3.0,1.5e-3\n"},
        Written{"HeaderInAComment", "# a note\n# t, F, x\n0,1.5,0.25\n0.001,-2.5,-0.5\n0.002,3.0,1.5e-3\n"},
        Written{"QuotedHeader", "\"t\",\"F\",\"x\"\n0,1.5,0.25\n0.001,-2.5,-0.5\n0.002,3.0,1.5e-3\n"},
        Written{"QuotedHeaderWithBlanks", "\"t\" \"F\" \"x\"\n0 1.5 0.25\n0.001 -2.5 -0.5\n0.002 3.0 1.5e-3\n"},
        Written{
            "QuotedNumbersWithDecimalCommas",
            "\"t\",\"F\",\"x\"\n\"0\",\"1,5\",\"0,25\"\n\"0,001\",\"-2,5\",\"-0,5\"\n\"0,002\",\"3,0\",\"1,5e-3\"\n"},
        Written{"UnitsInTheHeader", "t [s],F [N],x (m)\n0,1.5,0.25\n0.001,-2.5,-0.5\n0.002,3.0,1.5e-3\n"},
        Written{"UnitsInALine", "t,F,x\ns,N,m\n0,1.5,0.25\n0.001,-2.5,-0.5\n0.002,3.0,1.5e-3\n"},
        Written{"UnitsInALineAndBrackets", "t;F;x\n[s];[N];[m]\n0;1.5;0.25\n0.001;-2.5;-0.5\n0.002;3.0;1.5e-3\n"},
        Written{"Preamble",
                "Logger 7\nDate;today\nRate;1000\n\nt;F;x\n0;1.5;0.25\n0.001;-2.5;-0.5\n0.002;3.0;1.5e-3\n"},
        Written{"OtherCase", "Time,f,X\n0,1.5,0.25\n0.001,-2.5,-0.5\n0.002,3.0,1.5e-3\n"},
        Written{"PlusSigns", "t,F,x\n0,+1.5,+.25\n+0.001,-2.5,-.5\n0.002,3.,+1.5e-3\n"},
        Written{"EmptyLineAtTheEnd", "t,F,x\n0,1.5,0.25\n0.001,-2.5,-0.5\n0.002,3.0,1.5e-3\n\n  \n"}),
    [](const auto& written) { return std::string(written.param.how); });

TEST_F(TextRecording, ReadsColumnsOfTextWithoutTakingThemForTheHeader) {
  const auto recording = read("t,state,F\n0,idle,1\n0.5,run,2\n1,run,3\n", columns_named({"F"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0, 3.0}));
  EXPECT_DOUBLE_EQ(recording->sampling_period, 0.5);
}

TEST_F(TextRecording, ReadsColumnsByNumberWhereThereIsNoHeader) {
  const auto recording = read("1,2\n3,4\n5,6\n", at_1_khz({"2", "1"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{2.0, 4.0, 6.0}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{1.0, 3.0, 5.0}));
  EXPECT_EQ(recording->channels[0].name, "2");
  EXPECT_TRUE(mentions(recording->remarks, "no header"));
}

TEST_F(TextRecording, TellsTheHeaderFromTheRowsAsTheUserSays) {
  RecordingOptions options = at_1_khz({"2"});
  options.header = RecordingOptions::Header::present;
  const auto named = read("1,2\n3,4\n5,6\n", options);
  ASSERT_TRUE(named.has_value());
  EXPECT_EQ(named->channels[0].samples, (Samples{4.0, 6.0}));
  EXPECT_TRUE(mentions(named->remarks, "the header in line 1 has numbers"));
  options.header = RecordingOptions::Header::absent;
  EXPECT_EQ(refusal("F,x\n3,4\n5,6\n", options), "1:3: 2: no_number_in_cell cell=\"x\" decimal_mark=.");
  EXPECT_EQ(refusal("a,b,c\n3,4\n5,6\n", options),
            "1:1: wrong_number_of_cells cells=3 expected=2 rows=0 as=most_lines");
}

TEST_F(TextRecording, TakesAFaultyFirstRowForARow) {
  EXPECT_EQ(refusal("F,x\nabc,1\n2,3\n4,5\n", at_1_khz({"F"})),
            "2:1: F: no_number_in_cell line=2 cell=\"abc\" decimal_mark=. as=header");
}

// One column with decimal commas, or two of whole numbers: the header decides, else the user.
TEST_F(TextRecording, TellsDecimalCommasFromDelimitersByTheHeader) {
  const auto one = read("F\n1,5\n2,5\n", at_1_khz({"F"}));
  ASSERT_TRUE(one.has_value()) << one.error().str();
  EXPECT_EQ(one->channels[0].samples, (Samples{1.5, 2.5}));
  const auto two = read("F,x\n1,5\n2,5\n", at_1_khz({"F"}));
  ASSERT_TRUE(two.has_value());
  EXPECT_EQ(two->channels[0].samples, (Samples{1.0, 2.0}));
  RecordingOptions options = at_1_khz({"1"});
  options.decimal_mark = ',';
  const auto stated = read("1,5\n2,5\n", options);
  ASSERT_TRUE(stated.has_value());
  EXPECT_EQ(stated->channels[0].samples, (Samples{1.5, 2.5}));
}

TEST_F(TextRecording, LearnsTheDecimalMarkWhereTheFirstLinesHaveNone) {
  std::string text = "F;x\n";
  for (int i = 0; i < 1000; ++i) text += "0;0\n";
  const auto comma = read(text + "0,5;0\n1,5;0,25\n", at_1_khz({"F"}));
  ASSERT_TRUE(comma.has_value()) << comma.error().str();
  EXPECT_EQ(comma->channels[0].samples.back(), 1.5);
  const auto point = read(text + "0.5;0\n1.5;0.25\n", at_1_khz({"F"}));
  ASSERT_TRUE(point.has_value());
  EXPECT_EQ(point->channels[0].samples.back(), 1.5);
  EXPECT_EQ(refusal(text + "0,5;0\n1.5;0\n", at_1_khz({"F"})),
            "1003:1: F: no_number_in_cell cell=\"1.5\" decimal_mark=, why=decimal_mark");
}

TEST_F(TextRecording, PassesOverCommentsHoweverLong) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "# setting " + std::to_string(i) + "\n";
  const auto recording = read(text + "# t F\n0 1\n1 2\n", columns_named({"F"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0}));
}

TEST_F(TextRecording, TakesALineOfTabsForARowWithoutNumbers) {
  std::string text = "F\tx\n";
  for (int i = 0; i < 200; ++i) text += i == 100 ? "\t\n" : std::to_string(i) + "\t7\n";
  const auto recording = read(text, at_1_khz({"F"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples[100], 100.0);
}

TEST_F(TextRecording, ScalesAndKeepsTheOrderOfTheRequests) {
  RecordingOptions options;
  options.columns = {{"x", 1e-3}, {"F", -2.0}, {"x", 1.0}};
  options.rate = 100.0;
  const auto recording = read("F,x\n1,2\n3,4\n", options);
  ASSERT_TRUE(recording.has_value());
  EXPECT_EQ(recording->sampling_period, 0.01);
  EXPECT_EQ(recording->channels[0].samples, (Samples{0.002, 0.004}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{-2.0, -6.0}));
  EXPECT_EQ(recording->channels[2].samples, (Samples{2.0, 4.0}));
  EXPECT_EQ(recording->source, path("a.csv"));
}

TEST_F(TextRecording, ReadsAColumnInTheUnitOfItsName) {
  constexpr double turn = 2.0 * std::numbers::pi;
  const std::pair<const char*, double> cases[] = {{"x [mm]", 1e-3},
                                                  {"x_mm", 1e-3},
                                                  {"torque (mNm)", 1e-3},
                                                  {"torque_mNm", 1e-3},
                                                  {"angle_deg", turn / 360.0},
                                                  {"position_turns", turn},
                                                  {"x [m]", 1.0},
                                                  {"force_in", 1.0},
                                                  {"torque_nm", 1.0},
                                                  {"x_um", 1e-6}};
  for (const auto& [name, scale] : cases) {
    RecordingOptions options = at_1_khz({"2"});
    const std::string text = fmt::format("F [N],{}\n1,2\n3,4\n", name);
    const auto recording = read(text, options);
    ASSERT_TRUE(recording.has_value()) << recording.error().str();
    EXPECT_DOUBLE_EQ(recording->channels[0].samples[1], 4.0 * scale) << name;
    EXPECT_EQ(mentions(recording->remarks, "read in base units"), scale != 1.0) << name;
    options.columns[0].scale = -1.0;
    EXPECT_DOUBLE_EQ(read(text, options)->channels[0].samples[1], -4.0 * scale) << name;
    options.columns[0].scale = 0.5;  // what the user says is all there is
    EXPECT_EQ(read(text, options)->channels[0].samples[1], 2.0) << name;
  }
}

TEST_F(TextRecording, ReadsTheTimeInTheUnitOfItsName) {
  for (const char* header : {"t [ms],F", "time_ms,F", "Time (ms),F", "millis,F"}) {
    const auto recording = read(std::string(header) + "\n0,1\n2,2\n4,3\n", columns_named({"F"}));
    ASSERT_TRUE(recording.has_value()) << recording.error().str();
    EXPECT_DOUBLE_EQ(recording->sampling_period, 2e-3) << header;
    EXPECT_TRUE(mentions(recording->remarks, "as its name says")) << header;
  }
  RecordingOptions options = columns_named({"F"});
  options.time_scale = 1e-6;
  EXPECT_DOUBLE_EQ(read("t [ms],F\n0,1\n2,2\n4,3\n", options)->sampling_period, 2e-6);
}

// A logger of a microcontroller: no header, semicolons, a 16-bit timer in microseconds, about 1012 us per row.
TEST_F(TextRecording, SaysThatTheGivenRateContradictsTheTimes) {
  const std::string text = "t [ms],x\n0,1\n1,2\n2,3\n3,4\n";
  const auto with_rate = [&](double rate) {
    RecordingOptions options = columns_named({"x"});
    options.rate = rate;
    return read(text, options);
  };
  const auto twice = with_rate(2000.0);
  ASSERT_TRUE(twice.has_value());
  EXPECT_EQ(twice->sampling_period, 0.5e-3);
  EXPECT_EQ(warnings_in(twice->remarks), 1U);
  EXPECT_EQ(twice->doubts.size(), 1U);
  EXPECT_TRUE(mentions(twice->remarks, "the rate is given as 2000 Hz; the times in column t [ms] say 1000 Hz"));
  const auto right = with_rate(1005.0);
  ASSERT_TRUE(right.has_value());
  EXPECT_EQ(warnings_in(right->remarks), 0U);
  EXPECT_TRUE(right->doubts.empty());
  // A count of microseconds, not said to be one.
  RecordingOptions in_microseconds = columns_named({"x"});
  in_microseconds.rate = 2500.0;
  const auto counted = read("time,x\n400,1\n800,2\n1200,3\n", in_microseconds);
  ASSERT_TRUE(counted.has_value());
  EXPECT_EQ(warnings_in(counted->remarks), 0U);
  // A timer that falls back says nothing.
  RecordingOptions options = columns_named({"x"});
  options.rate = 10.0;
  const auto wrapped = read("t,x\n65534,1\n65535,2\n0,3\n", options);
  ASSERT_TRUE(wrapped.has_value());
  EXPECT_EQ(warnings_in(wrapped->remarks), 0U);
}

TEST_F(TextRecording, ReadsATimerThatWrapsByOptionsAlone) {
  std::string text;
  Samples force;
  unsigned time = 40000;
  for (int i = 0; i < 500; ++i) {
    force.push_back(std::round(1000.0 * std::sin(0.1 * i)) / 1000.0);
    text += std::to_string(time % 65536) + ";" + std::to_string(i) + ";" + std::to_string(force.back()) + "\n";
    time += i % 3 == 0 ? 1016U : 1010U;  // mean 1012
  }
  RecordingOptions options = columns_named({"3"});
  options.time_column = "1";
  options.time_scale = 1e-6;
  EXPECT_EQ(refusal(text, options), "27:1: 1: times_not_rising time=65304 after=778 bits=16");
  options.timer_bits = 16;
  const auto recording = read(text, options);
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_NEAR(recording->sampling_period, 1012e-6, 0.01e-6);
  EXPECT_EQ(recording->channels[0].samples, force);
  EXPECT_EQ(warnings_in(recording->remarks), 0U);
}

TEST_F(TextRecording, FillsTheFewSamplesThatAreMissing) {
  std::string text = "F,x\n";
  for (int i = 0; i < 300; ++i) {
    text += (i == 100 || i == 101 ? (i == 100 ? "NaN" : "") : std::to_string(i)) + "," + (i == 0 ? "-inf" : "7") + "\n";
  }
  const auto recording = read(text, at_1_khz({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  for (int i = 0; i < 300; ++i) EXPECT_DOUBLE_EQ(recording->channels[0].samples[static_cast<std::size_t>(i)], i);
  EXPECT_EQ(recording->channels[1].samples, Samples(300, 7.0));
  EXPECT_TRUE(mentions(recording->remarks,
                       "F: 2 of 300 samples are missing (NaN, infinite or empty), the first at "
                       "line 102, at most 2 in a row; filled by straight lines"));
}

TEST_F(TextRecording, RoundsNumbersTooSmallToZero) {
  const auto recording = read("F\n1e-999\n-1e-999\n4.9e-324\n", at_1_khz({"F"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{0.0, 0.0, 4.9e-324}));
}

TEST_F(TextRecording, LeavesOutALastLineThatIsCutOff) {
  const auto recording = read("t,F\n0,1\n1,2\n2", columns_named({"F"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0}));
  EXPECT_TRUE(mentions(recording->remarks, "the last line, 4, is cut off after 1 of 2 cells"));
}

TEST_F(TextRecording, SaysThatEmptyLinesSeparateRows) {
  const auto recording = read("t,F\n0,1\n1,2\n\n\n2,3\n", columns_named({"F"}));
  ASSERT_TRUE(recording.has_value());
  EXPECT_EQ(recording->channels[0].samples.size(), 3U);
  EXPECT_TRUE(mentions(recording->remarks, "2 empty lines between the rows"));
}

TEST_F(TextRecording, PrefersTheExactNameOfAColumn) {
  const auto recording = read("F [N],F,f,2\n1,2,3,4\n5,6,7,8\n", at_1_khz({"F", "F [N]", "f", "2", "1"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  const Samples first{recording->channels[0].samples[0], recording->channels[1].samples[0],
                      recording->channels[2].samples[0], recording->channels[3].samples[0],
                      recording->channels[4].samples[0]};
  EXPECT_EQ(first, (Samples{2.0, 1.0, 3.0, 4.0, 1.0}));
}

TEST_F(TextRecording, ReadsStandardInput) {
  const int saved = dup(STDIN_FILENO);
  ASSERT_NE(std::freopen(write("input", "t,F\n0,1\n1,2\n").c_str(), "r", stdin), nullptr);
  const auto recording = read_recording("-", columns_named({"F"}));
  ASSERT_NE(std::freopen(write("input", std::string(128, '\0')).c_str(), "r", stdin), nullptr);
  RecordingOptions mat = columns_named({"F"});
  mat.format = RecordingFormat::mat;
  const auto refused = read_recording("-", mat);
  dup2(saved, STDIN_FILENO);
  close(saved);
  clearerr(stdin);
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->source, "standard input");
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0}));
  EXPECT_EQ(refused.error().place.file, "standard input");
  EXPECT_EQ(data_of(refused.error()), "format_needs_a_file format=MAT");
}

// Blocks end anywhere: the rows of a file of several blocks are those that were written.
TEST_F(TextRecording, StreamsFilesLongerThanABlock) {
  constexpr std::size_t rows = 200000;
  std::string text = "t,skipped,F\n";
  for (std::size_t i = 0; i < rows; ++i) {
    text += std::to_string(i) + "e-4,0.12345," + std::to_string(static_cast<double>(i * i % 1013)) + "\n";
  }
  double last = 0.0;
  std::size_t calls = 0;
  const auto progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    last = fraction;
    ++calls;
  };
  const auto recording = read_recording(write("long.csv", text), columns_named({"F"}), progress);
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(last, 1.0);
  EXPECT_GE(calls, text.size() >> 20);
  ASSERT_EQ(recording->channels[0].samples.size(), rows);
  for (std::size_t i = 0; i < rows; ++i) {
    ASSERT_EQ(recording->channels[0].samples[i], static_cast<double>(i * i % 1013)) << i;
  }
  EXPECT_NEAR(recording->sampling_period, 1e-4, 1e-15);
}

TEST_F(TextRecording, ListsItsColumns) {
  const auto contents = list_recording(write("a.csv", "t,state,F \xB5\n0,idle,1\n0.5,run,2\n1,run,3\n"));
  ASSERT_TRUE(contents.has_value()) << contents.error().str();
  EXPECT_EQ(contents->format, RecordingFormat::text);
  ASSERT_EQ(contents->columns.size(), 3U);
  EXPECT_EQ(contents->columns[1].name, "state");
  EXPECT_EQ(contents->columns[1].size, 3U);
  EXPECT_EQ(contents->columns[1].detail, "text: \"idle\"");
  EXPECT_EQ(contents->columns[2].name, "F \u00b5");  // Latin-1, as UTF-8
  EXPECT_EQ(contents->columns[2].detail, "numbers");
}

}  // namespace
}  // namespace zwidth
