// CSV exports of dSPACE ControlDesk: lines of metadata, then rows from "trace_values" on.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "io/recording_folder.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
namespace {

using Samples = std::vector<double>;

std::string with_points() {
  return "recorder,Recorder 1\ncreated,2024-05-06 10:11:12\ntrace_names,,F,x\n"
         "path,,Model Root/Out/F,Model "
         "Root/In/x\nunit,s,N,mm\ntrace_values,0.0,1.5,0.25\n,0.001,2.5,-0.5\n,0.002,3,1.5e-3\n";
}

std::string with_commas() {
  return "recorder;Recorder 1\ntrace_names;;F;x\npath;;Model Root/Out/F;Model Root/In/x\nunit;s;N;mm\n"
         "trace_values;0,0;1,5;0,25\n;0,001;2,5;-0,5\n;0,002;3;1,5e-3\n";
}

class ControldeskExport : public TextRecording {};

TEST_F(ControldeskExport, ReadsRowsFromItsValuesOn) {
  for (const std::string& text : {with_points(), with_commas()}) {
    const auto recording = read(text, columns_named({"F", "x"}));
    ASSERT_TRUE(recording.has_value()) << recording.error().str();
    EXPECT_NEAR(recording->sampling_period, 1e-3, 1e-15);
    EXPECT_EQ(recording->channels[0].samples, (Samples{1.5, 2.5, 3.0}));
    EXPECT_EQ(recording->channels[0].name, "F [N]");
    EXPECT_NEAR(recording->channels[1].samples[1], -0.5e-3, 1e-18);
    EXPECT_EQ(warnings_in(recording->remarks), 0U);
  }
}

TEST_F(ControldeskExport, SignalsAreCalledByTheEndOfTheirPathWithoutNames) {
  const auto contents = list_recording(write(
      "a.csv",
      "\"path\",\"\",\"Model Root/Out/F\",\"Model Root/In/x\"\n\"trace_values\",0.0,1.5,0.25\n,0.001,2.5,-0.5\n"));
  ASSERT_TRUE(contents.has_value()) << contents.error().str();
  ASSERT_EQ(contents->columns.size(), 3U);
  EXPECT_EQ(contents->columns[0].name, "time [s]");
  EXPECT_EQ(contents->columns[1].name, "F");
  EXPECT_EQ(contents->columns[2].name, "x");
  EXPECT_EQ(contents->columns[2].size, 2U);
}

std::string two_sections(std::string_view second_rows) {
  return "trace_names,,F\npath,,Out/F\ntrace_values,0.0,1\n,0.001,2\n,0.002,3\n\n"
         "trace_names,,x\npath,,In/x\n" +
         std::string(second_rows);
}

TEST_F(ControldeskExport, SectionsHaveTimesOfTheirOwn) {
  const auto recording = read(two_sections("trace_values,0.001,7\n,0.002,8\n,0.003,9\n"), columns_named({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{2.0, 3.0}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{7.0, 8.0}));
  const auto slow = read(two_sections("trace_values,0.0,7\n,0.002,8\n"), columns_named({"F", "x"}));
  ASSERT_FALSE(slow.has_value());
  EXPECT_EQ(slow.error().place.line, 10U);
}

TEST_F(ControldeskExport, LeavesOutALastRowThatIsCutOff) {
  const auto recording = read(with_points() + ",0.003,4", columns_named({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.5, 2.5, 3.0}));
  EXPECT_EQ(warnings_in(recording->remarks), 1U);
}

TEST_F(ControldeskExport, RefusesDamageWithItsLine) {
  const auto line = [&](const std::string& text, const std::string& asked = "F") {
    const auto recording = read(text, columns_named({asked}));
    return recording ? 0U : recording.error().place.line;
  };
  const std::string good = with_points();  // 8 lines
  EXPECT_EQ(line(good + ",0.003,4\n,0.004,5,6\n"), 9U);
  EXPECT_EQ(line(good + ",0.003,4,5,6\n"), 9U);
  EXPECT_EQ(line(good + ",later,4,5\n"), 9U);
  EXPECT_EQ(line(good + ",0.003,a,5\n"), 9U);
  EXPECT_EQ(line(good + ",0.003,4,a\n"), 0U);  // x is not asked for
  EXPECT_EQ(line(good + "unit,s,N,m\n"), 9U);
  EXPECT_EQ(line(good + "\n,0.003,4,5\n"), 10U);
  EXPECT_EQ(line("recorder,1\ntrace_values,0.0,1.5\n,0.1,2\n"), 2U);
  EXPECT_EQ(line("path,,F\ntrace_values,0.0\n,0.1\n"), 2U);
}

TEST_F(ControldeskExport, AnyBeginningIsReadOrRefused) {
  const std::string text = with_points();
  const Samples all{1.5, 2.5, 3.0};
  for (std::size_t size = 0; size < text.size(); ++size) {
    const auto recording = read(text.substr(0, size), columns_named({"F", "x"}));
    if (!recording) continue;
    const Samples& samples = recording->channels[0].samples;
    ASSERT_LE(samples.size(), all.size());
    EXPECT_TRUE(std::equal(samples.begin(), samples.end(), all.begin())) << size;
  }
}

}  // namespace
}  // namespace zwidth
