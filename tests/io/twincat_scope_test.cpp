// Exports of TwinCAT Scope: the layouts that its export writes, whole, cut and damaged.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "io/recording_folder.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
namespace {

using Samples = std::vector<double>;

std::string preamble(char tab) {
  return fmt::format(
      "Name{0}Scope Project{0}\nFile{0}D:\\traces\\run 1.csv\nStarttime of export{0}132959733843760000{0}Montag, 2. "
      "Mai "
      "2022{0}15:56:24.376\nEndtime of export{0}132959733853750000{0}Montag, 2. Mai 2022{0}15:56:25.375\n\n\n",
      tab);
}

/// 12 channels with a time column each: 24 cells a row, 22 once the slow one has ended; 20 lines of header. F is the
/// first channel, in N, x the second, in mm; the last is sampled at 500 Hz.
std::string twelve_channels(char tab, char mark, int rows) {
  std::string text = preamble(tab);
  constexpr int channels = 12;
  const auto header = [&](const std::string& key, auto&& value) {
    for (int c = 0; c < channels; ++c)
      text += fmt::format("{}{}{}{}", c == 0 ? "" : std::string(1, tab), key, tab, value(c));
    text += "\n";
  };
  header("Name", [](int c) { return c == 0 ? "F" : c == 1 ? "x" : fmt::format("ch {}", c); });
  header("SymbolComment", [](int) { return ""; });
  header("Data-Type", [](int) { return "REAL64"; });
  header("SampleTime[ms]", [&](int c) { return c == 11 ? "2" : "1"; });
  header("VariableSize", [](int) { return "8"; });
  header("SymbolBased", [](int) { return "True"; });
  header("IndexGroup", [](int) { return "16448"; });
  header("IndexOffset", [](int c) { return std::to_string(385000 + c); });
  header("SymbolName", [](int c) { return fmt::format("MAIN.v{}", c); });
  header("Offset", [](int) { return "0"; });
  header("ScaleFactor", [](int) { return "1"; });
  header("BitMask", [](int) { return "0xffffffffffffffff"; });
  header("Unit", [](int c) { return c == 0 ? "N (Force)" : c == 1 ? "mm (Length)" : "(None)"; });
  text += "\n";
  const auto decimal = [&](double value) {
    std::string number = fmt::format("{}", value);
    for (char& c : number) c = c == '.' ? mark : c;
    return number;
  };
  for (int i = 0; i < rows; ++i) {
    for (int c = 0; c < channels - 1; ++c) {
      const double value = c == 0 ? 0.5 * i : c == 1 ? 0.25 - i : 10.5 * c + i;
      text += fmt::format("{}{}{}{}", c == 0 ? "" : std::string(1, tab), i, tab, decimal(value));
    }
    if (2 * i < rows) text += fmt::format("{}{}{}{}", tab, 2 * i, tab, decimal(100.5 + i));
    text += "\n";
  }
  return text;
}

Samples force(int rows) {
  Samples samples;
  for (int i = 0; i < rows; ++i) samples.push_back(0.5 * i);
  return samples;
}

RecordingOptions columns_unscaled(const std::vector<std::string>& names) {
  RecordingOptions options;
  for (const std::string& name : names) options.columns.push_back({name, {}});
  return options;
}

class TwincatScope : public TextRecording {};

struct ScopeText {
  const char* how;
  char tab;
  char mark;
};
class ScopeSeparators : public TextRecording, public testing::WithParamInterface<ScopeText> {};

TEST_P(ScopeSeparators, ReadTwelveChannelsWithTimesOfTheirOwn) {
  const auto& [how, tab, mark] = GetParam();
  const std::string text = twelve_channels(tab, mark, 40);
  const auto recording = read(text, columns_unscaled({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_NEAR(recording->sampling_period, 1e-3, 1e-15);
  EXPECT_EQ(recording->channels[0].samples, force(40));
  EXPECT_EQ(recording->channels[0].name, "F [N]");
  EXPECT_EQ(recording->channels[0].quantity, StatedQuantity::force);
  EXPECT_NEAR(recording->channels[1].samples[3], -2.75e-3, 1e-15);
  EXPECT_EQ(recording->channels[1].base_unit, "m");
  EXPECT_TRUE(recording->doubts.empty());
  EXPECT_EQ(warnings_in(recording->remarks), 0U);
}

INSTANTIATE_TEST_SUITE_P(Texts, ScopeSeparators,
                         testing::Values(ScopeText{"TabsAndCommas", '\t', ','}, ScopeText{"TabsAndPoints", '\t', '.'},
                                         ScopeText{"SemicolonsAndCommas", ';', ','},
                                         ScopeText{"SemicolonsAndPoints", ';', '.'}, ScopeText{"Commas", ',', '.'}),
                         [](const auto& tested) { return tested.param.how; });

TEST_F(TwincatScope, CarriageReturnsAndByteOrderMarkChangeNothing) {
  std::string text = twelve_channels('\t', ',', 20);
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2))
    text.replace(at, 1, "\r\n");
  const auto recording = read("\xEF\xBB\xBF" + text + "EOF", columns_unscaled({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, force(20));
}

TEST_F(TwincatScope, ListsTheChannelsAndTheirTimes) {
  const auto contents = list_recording(write("a.csv", twelve_channels('\t', ',', 40)));
  ASSERT_TRUE(contents.has_value()) << contents.error().str();
  ASSERT_EQ(contents->columns.size(), 24U);
  EXPECT_EQ(contents->columns[0].name, "time of F [ms]");
  EXPECT_EQ(contents->columns[1].name, "F [N]");
  EXPECT_EQ(contents->columns[1].size, 40U);
  EXPECT_EQ(contents->columns[23].size, 20U);  // the slow channel
}

TEST_F(TwincatScope, ColumnsHaveTheirNumbersOfTheRow) {
  const auto recording = read(twelve_channels('\t', ',', 40), columns_unscaled({"2", "4"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].name, "F [N]");
  EXPECT_EQ(recording->channels[1].name, "x [mm]");
}

// A slow channel's rows stand beside the first fast ones: row by row they are of other times.
TEST_F(TwincatScope, RefusesChannelsOfOtherTimes) {
  const auto recording = read(twelve_channels('\t', ',', 40), columns_unscaled({"F", "ch 11"}));
  ASSERT_FALSE(recording.has_value());
  EXPECT_EQ(recording.error().place.line, 22U);  // rows from line 21: the second stamp differs
  EXPECT_EQ(recording.error().place.key, "ch 11");
  ASSERT_EQ(recording.error().problem->code, ProblemCode::columns_of_other_times);
  EXPECT_NEAR(recording.error().problem->evidence.at(3).value, 500.0, 1e-6);   // rate
  EXPECT_NEAR(recording.error().problem->evidence.at(7).value, 1000.0, 1e-6);  // other_rate
  const auto beside_a_rate = [&] {
    RecordingOptions options = columns_unscaled({"F", "ch 11"});
    options.rate = 1000.0;
    return read(twelve_channels('\t', ',', 40), options).has_value();
  };
  EXPECT_FALSE(beside_a_rate());
}

std::string shared_times(std::string_view rows) {
  return preamble('\t') + "Name\tF\tx\tName\ty\nSampleTime[ms]\t1\t1\tSampleTime[ms]\t1\nUnit\tN\tm\tUnit\tm\n\n" +
         std::string(rows);
}

TEST_F(TwincatScope, ChannelsOfOneSampleTimeShareAColumn) {
  const auto recording = read(shared_times("0\t1,5\t0,1\t0\t7\n1\t2,5\t0,2\t1\t8\n2\t3,5\t0,3\t2\t9\nEOF\n"),
                              columns_unscaled({"F", "x", "y"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.5, 2.5, 3.5}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{0.1, 0.2, 0.3}));
  EXPECT_EQ(recording->channels[2].samples, (Samples{7.0, 8.0, 9.0}));
}

// y starts 2 ms early and ends 1 ms early: what both have is put together by its times.
TEST_F(TwincatScope, TakesTheCommonSpanByItsTimes) {
  const auto recording =
      read(shared_times(
               "0\t1\t0,1\t-2\t6\n1\t2\t0,2\t-1\t7\n2\t3\t0,3\t0\t8\n3\t4\t0,4\t1\t9\n4\t5\t0,5\t2\t10\n5\t6\t0,6\n"),
           columns_unscaled({"F", "y"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0, 3.0}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{8.0, 9.0, 10.0}));
  EXPECT_NEAR(recording->sampling_period, 1e-3, 1e-15);
  EXPECT_TRUE(mentions(recording->remarks, "3 of 6 samples"));
}

TEST_F(TwincatScope, RefusesTimesThatLieBetweenEachOther) {
  EXPECT_EQ(
      read(shared_times("0\t1\t0,1\t0,3\t6\n1\t2\t0,2\t1,3\t7\n2\t3\t0,3\t2,3\t8\n"), columns_unscaled({"F", "y"}))
          .has_value(),
      false);
}

TEST_F(TwincatScope, ShiftedAndEndedGroupsHaveEmptyCells) {
  const auto recording = read(shared_times("0\t1\t0,1\t \t \n1\t2\t0,2\t1\t7\n2\t3\t0,3\t2\t8\n \t \t \t3\t9\n"),
                              columns_unscaled({"F", "y"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{2.0, 3.0}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{7.0, 8.0}));
}

// "Fill with previous value" writes a slow sample beside each fast one.
TEST_F(TwincatScope, CountsTheRepeatsOfASlowChannelOnce) {
  const std::string text =
      preamble(';') + "Name;F;Name;y;z\nUnit;N;Unit;m;m\n\n0;1;0;5;1\n1;2;0;5;1\n2;3;2;6;2\n3;4;2;6;2\n4;5;4;7;3\n";
  const auto recording = read(text, columns_unscaled({"y", "z"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{5.0, 6.0, 7.0}));
  EXPECT_NEAR(recording->sampling_period, 2e-3, 1e-15);
  const auto refused = read(text, columns_unscaled({"F", "y"}));
  EXPECT_FALSE(refused.has_value());
}

// 18 digits of 100 ns are more than a double holds.
TEST_F(TwincatScope, ReadsAbsoluteTimesToTheLastDigit) {
  std::string text = preamble('\t') + "Name\tF\tx\nUnit\tN\tm\n\n";
  constexpr std::uint64_t start = 132959733843760000;
  for (int i = 0; i < 50; ++i) text += fmt::format("{}\t{}\t{}\n", start + 1250U * static_cast<unsigned>(i), i % 7, i);
  const auto recording = read(text, columns_unscaled({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_NEAR(recording->sampling_period, 125e-6, 1e-16);
  EXPECT_EQ(warnings_in(recording->remarks), 0U);
}

TEST_F(TwincatScope, OneTimeColumnIsCalledTime) {
  const auto contents = list_recording(write("a.csv", preamble(',') + "Name,F,x\n\n0,1,2\n1,1,2\n"));
  ASSERT_TRUE(contents.has_value()) << contents.error().str();
  EXPECT_EQ(contents->columns[0].name, "time [ms]");
}

TEST_F(TwincatScope, ReadsAHeaderOfNamesAlone) {
  const auto recording =
      read("Name,YT Scope Project,\nFile,C:\\a.csv,\n\nName,F,Name,x\n0,1.5,0,2\n1,2.5,1,3\n2,1,2,1\n",
           columns_unscaled({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.5, 2.5, 1.0}));
}

TEST_F(TwincatScope, PassesOverATableOfTriggers) {
  const auto recording =
      read(preamble('\t') + "TriggerGroup\tCount\tReleaseTime\tComment\nGroup\t1\t132959733843760000\t\n\n" +
               "Name\tF\tx\nUnit\tN\tm\n\n0\t1\t2\n1\t2\t3\n",
           columns_unscaled({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0}));
}

std::string scaled(const std::string& factor, const std::string& offset) {
  return preamble('\t') + fmt::format(
                              "Name\tF\tx\nOffset\t0\t{}\nScaleFactor\t1\t{}\nUnit\tN\tm\nUnit ScaleFactor\t1\t1\n"
                              "Unit Offset\t0\t0\n\n0\t1\t2\n1\t2\t3\n2\t1\t2\n",
                              offset, factor);
}

// The export scales only where it was asked to, and its file does not say so.
TEST_F(TwincatScope, AScaleThatMayBeAppliedOrNotIsADoubt) {
  const auto open = read(scaled("0,001", "4"), columns_unscaled({"F", "x"}));
  ASSERT_TRUE(open.has_value()) << open.error().str();
  ASSERT_EQ(open->doubts.size(), 1U);
  EXPECT_EQ(open->doubts[0].code, FindingCode::stated_scale_unclear);
  EXPECT_EQ(open->doubts[0].evidence, (std::vector<Evidence>{{"factor", 0.001}, {"offset", 4.0}}));
  EXPECT_EQ(open->channels[1].samples, (Samples{2.0, 3.0, 2.0}));
  EXPECT_TRUE(mentions(open->remarks, "0.001"));
  const auto settled = read(scaled("0,001", "4"), columns_named({"F", "x"}));  // with the scale 1
  ASSERT_TRUE(settled.has_value());
  EXPECT_TRUE(settled->doubts.empty());
  const auto of_another = read(scaled("0,001", "4"), columns_unscaled({"F", "F"}));
  EXPECT_TRUE(of_another->doubts.empty());
  const auto offset = read(scaled("1", "4"), columns_unscaled({"F", "x"}));
  ASSERT_TRUE(offset.has_value());
  EXPECT_TRUE(offset->doubts.empty());
  EXPECT_EQ(warnings_in(offset->remarks), 0U);
}

TEST_F(TwincatScope, LeavesOutALastRowThatIsCutOff) {
  const auto recording =
      read(shared_times("0\t1\t0,1\t0\t7\n1\t2\t0,2\t1\t8\n2\t3\t0,3\t2"), columns_unscaled({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0}));
  EXPECT_EQ(warnings_in(recording->remarks), 1U);
}

TEST_F(TwincatScope, RefusesDamageWithItsLine) {
  const auto line = [&](std::string_view rows) {
    const auto recording = read(shared_times(rows), columns_unscaled({"F", "x"}));
    return recording ? 0U : recording.error().place.line;
  };
  EXPECT_EQ(line("0\t1\t2\t0\t1\n1\t1\t2\t1\n2\t1\t2\t2\t1\n"), 12U);        // within a group
  EXPECT_EQ(line("0\t1\t2\t0\t1\n1\t1\t2\t1\t1\t1\n2\t1\t2\t2\t1\n"), 12U);  // too many
  EXPECT_EQ(line("0\t1\t2\t0\t1\nx\t1\t2\t1\t1\n"), 12U);
  EXPECT_EQ(line("0\t1\t2\t0\t1\n1\ta\t2\t1\t1\n"), 12U);
  EXPECT_EQ(line("0\t1\t2\t0\t1\n\t1\t2\t1\t1\n"), 12U);  // a value without a time
  EXPECT_EQ(line("0\t1\t2\t0\t1\nEOF\n1\t1\t2\t1\t1\n"), 13U);
  EXPECT_EQ(line("0\t1\n1\t2\n"), 11U);                                  // no time columns
  EXPECT_EQ(line("0\t1\t2\t0\ta\n1\t1\t2\t1\t1\n2\t2\t2\t2\t2\n"), 0U);  // y is not asked for
}

TEST_F(TwincatScope, RefusesWhatCannotBeToldApart) {
  const auto message = [&](const std::string& text) {
    const auto recording = read(text, columns_unscaled({"F", "x"}));
    return recording ? "read" : data_of(*recording.error().problem);
  };
  EXPECT_EQ(message(preamble(' ') + "Name F x\n0 1 2\n1 2 3\n"), "separator_not_possible of=twincat separator=blanks");
  EXPECT_EQ(message(preamble('\t')), "no_columns format=twincat");
  EXPECT_EQ(message(preamble('\t') + "0\t1\t2\n1\t2\t3\n"), "line_without_header format=twincat");
  EXPECT_EQ(message(preamble(',') + "Name,F,x\n\n0,2,1,5,2,5\n0,3,1,5,2,5\n"),
            "wrong_number_of_cells cells=6 expected=3 as=channels");
  EXPECT_EQ(message(preamble('\t') + "Name\tF\tx\nUnit\tN\tm\n"), "too_few_samples samples=0");
}

// What is cut anywhere is read or refused, and no line of the header is ever a sample.
TEST_F(TwincatScope, AnyBeginningIsReadOrRefused) {
  const std::string text = twelve_channels('\t', ',', 3);
  for (std::size_t size = 0; size < text.size(); size += 7) {
    const auto recording = read(text.substr(0, size), columns_unscaled({"F", "x"}));
    if (!recording) {
      EXPECT_TRUE(recording.error().problem.has_value());
      continue;
    }
    for (std::size_t i = 0; i < recording->channels[0].samples.size(); ++i) {
      EXPECT_EQ(recording->channels[0].samples[i], 0.5 * static_cast<double>(i)) << size;
    }
  }
}

TEST_F(TwincatScope, APlainTableWithAColumnNameIsNone) {
  const auto recording = read("Name,t,F\n1,0,5\n2,1,6\n3,2,7\n", columns_named({"F"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{5.0, 6.0, 7.0}));
}

}  // namespace
}  // namespace zwidth
