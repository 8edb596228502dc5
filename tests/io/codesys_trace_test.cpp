// Traces that CODESYS saves as *.trace.csv: blocks of "; time; value", one for each variable.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/recording_folder.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
namespace {

using Samples = std::vector<double>;

std::string trace_header(const std::string& flags) {
  return "[key]; [value]\nVersion; 0x03050000\nName; Application.Trace\nApplicationName; Application\n"
         "IecTaskName; MainTask\nComment; \nTrigger.Flags; 0\nEveryNCycles; 1\nBufferEntries; 1000\nFlags; " +
         flags + "\n";
}

std::string variable(int index, const std::string& name, std::string_view samples) {
  return fmt::format(
      "{0}.Variable; {1}\n{0}.Address.AddrFlags; 0x00000000\n{0}.Class; 14\n{0}.Size; 4\n"
      "{0}.GraphColor; 4292519200\n{0}.CriticalLowerLimit; 0\n{0}.YAxis; 0\n{0}.Data; \n{2}",
      index, name, samples);
}

std::string two_variables(const std::string& flags = "16") {
  return trace_header(flags) + variable(0, "PLC_PRG.F", "; 2; 30\n; 4; 30.5\n; 6; -1.5e-3\n; 8; 2\n") +
         variable(1, "PLC_PRG.x", "; 2; 1\n; 4; 2\n; 6; 3\n; 8; 4\n");
}

class CodesysTrace : public TextRecording {};

TEST_F(CodesysTrace, ReadsItsVariables) {
  const auto recording = read(two_variables(), columns_named({"PLC_PRG.F", "PLC_PRG.x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_NEAR(recording->sampling_period, 2e-3, 1e-15);
  EXPECT_EQ(recording->channels[0].samples, (Samples{30.0, 30.5, -1.5e-3, 2.0}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{1.0, 2.0, 3.0, 4.0}));
  EXPECT_EQ(warnings_in(recording->remarks), 0U);
}

TEST_F(CodesysTrace, ReadsDecimalCommasAndCarriageReturns) {
  std::string text = trace_header("16") + variable(0, "F", "; 0; 1,5\n; 0,5; 2,5\n; 1; 3\n");
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2))
    text.replace(at, 1, "\r\n");
  const auto recording = read(text, columns_named({"F"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_NEAR(recording->sampling_period, 0.5e-3, 1e-15);
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.5, 2.5, 3.0}));
}

// The packet's flags say the unit of time: bit 4 ms, bit 5 us. A factor of 1000 is never guessed.
TEST_F(CodesysTrace, TheFlagsSayTheUnitOfTime) {
  const auto period = [&](const std::string& flags, RecordingOptions options) {
    options.columns = {{"PLC_PRG.F", 1.0}};
    const auto recording = read(two_variables(flags), options);
    return recording ? recording->sampling_period : 0.0;
  };
  EXPECT_NEAR(period("16", {}), 2e-3, 1e-15);
  EXPECT_NEAR(period("0x11", {}), 2e-3, 1e-15);
  EXPECT_NEAR(period("32", {}), 2e-6, 1e-18);
  EXPECT_EQ(period("0", {}), 0.0);
  EXPECT_EQ(period("48", {}), 0.0);
  EXPECT_EQ(period("", {}), 0.0);
  RecordingOptions stated;
  stated.time_scale = 1e-6;
  EXPECT_NEAR(period("0", stated), 2e-6, 1e-18);
  RecordingOptions rate;
  rate.rate = 500.0;
  EXPECT_NEAR(period("0", rate), 2e-3, 1e-15);
  const auto refused = read(two_variables("0"), columns_named({"PLC_PRG.F"}));
  EXPECT_EQ(refused.error().place.key, "Flags");
}

TEST_F(CodesysTrace, ListsVariablesBeforeTheirTimes) {
  const auto contents = list_recording(write("a.csv", two_variables("0")));
  ASSERT_TRUE(contents.has_value()) << contents.error().str();
  ASSERT_EQ(contents->columns.size(), 4U);
  EXPECT_EQ(contents->columns[0].name, "PLC_PRG.F");
  EXPECT_EQ(contents->columns[1].name, "PLC_PRG.x");
  EXPECT_EQ(contents->columns[1].size, 4U);
  EXPECT_EQ(contents->columns[2].name, "time of PLC_PRG.F");
}

// The buffer of one variable began earlier and ended earlier.
TEST_F(CodesysTrace, PutsVariablesTogetherByTheirTimes) {
  const auto recording = read(trace_header("16") + variable(0, "F", "; 2; 1\n; 4; 2\n; 6; 3\n; 8; 4\n") +
                                  variable(1, "x", "; 4; 20\n; 6; 30\n; 8; 40\n; 10; 50\n"),
                              columns_named({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{2.0, 3.0, 4.0}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{20.0, 30.0, 40.0}));
}

TEST_F(CodesysTrace, RefusesARowThatOneVariableLacks) {
  const auto recording = read(trace_header("16") + variable(0, "F", "; 2; 1\n; 4; 2\n; 6; 3\n; 8; 4\n") +
                                  variable(1, "x", "; 2; 10\n; 6; 30\n; 8; 40\n"),
                              columns_named({"F", "x"}));
  ASSERT_FALSE(recording.has_value());
  EXPECT_EQ(recording.error().place.line, 32U);  // x at 6 ms
  EXPECT_EQ(recording.error().place.key, "x");
}

TEST_F(CodesysTrace, RefusesDamageWithItsLine) {
  const auto line = [&](const std::string& text, const std::string& asked = "F") {
    const auto recording = read(text, columns_named({asked}));
    return recording ? 0U : recording.error().place.line;
  };
  const std::string header = trace_header("16");  // 10 lines
  const auto block = [&](std::string_view samples) { return header + variable(0, "F", samples); };
  EXPECT_EQ(line(header + "; 2; 30\n"), 11U);
  EXPECT_EQ(line(header + "0.Data; \n; 2; 30\n"), 11U);
  EXPECT_EQ(line(block("; 2; 30\n; 4\n; 6; 1\n")), 20U);
  EXPECT_EQ(line(block("; 2; 30\n; 4; 5; 6\n; 6; 1\n")), 20U);
  EXPECT_EQ(line(block("; 2; 30\n; x; 5\n; 6; 1\n")), 20U);
  EXPECT_EQ(line(block("; 2; 30\n; 4; TRUE\n; 6; 1\n")), 20U);
  EXPECT_EQ(line(block("; 2; 30\n; 4; 5\n; 3; 1\n")), 21U);  // the time falls
  EXPECT_EQ(line(block("; 2; TRUE\n; 4; TRUE\n") + variable(1, "x", "; 2; 1\n; 4; 2\n"), "x"), 0U);
  EXPECT_EQ(read(header, columns_named({"F"})).has_value(), false);
  EXPECT_EQ(read(block("; 2; 30\n"), columns_named({"F"})).has_value(), false);
}

TEST_F(CodesysTrace, LeavesOutALastSampleThatIsCutOff) {
  const auto recording = read(trace_header("16") + variable(0, "F", "; 2; 30\n; 4; 31\n; 6; "), columns_named({"F"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{30.0, 31.0}));
  EXPECT_EQ(warnings_in(recording->remarks), 1U);
}

TEST_F(CodesysTrace, AnyBeginningIsReadOrRefused) {
  const std::string text = two_variables();
  for (std::size_t size = 0; size < text.size(); ++size) {
    const auto recording = read(text.substr(0, size), columns_named({"PLC_PRG.x"}));
    if (!recording) continue;
    for (std::size_t i = 0; i < recording->channels[0].samples.size(); ++i) {
      EXPECT_EQ(recording->channels[0].samples[i], 1.0 + static_cast<double>(i)) << size;
    }
  }
}

TEST_F(CodesysTrace, TheTraceInXmlIsToldSo) {
  EXPECT_EQ(refusal("<?xml version=\"1.0\"?>\n<Trace>\n", columns_named({"F"})), "no_text_table kind=xml");
  EXPECT_EQ(refusal(std::string_view("\xFF\xFE<\0T\0", 6), columns_named({"F"})), "no_text_table kind=trace_in_utf16");
}

}  // namespace
}  // namespace zwidth
