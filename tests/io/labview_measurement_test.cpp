// LabVIEW measurement files (.lvm): one, many and no columns of X values, segments, special blocks, comments.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "io/recording_folder.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
namespace {

using Samples = std::vector<double>;

std::string file_header(const std::string& x_columns, char mark = '.') {
  return fmt::format(
      "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t{1}\n"
      "Multi_Headings\tYes\nX_Columns\t{0}\nTime_Pref\tAbsolute\nOperator\tme\nDate\t2016/08/23\n"
      "Time\t10:45:47{1}0352557312499836422\n***End_of_Header***\t\n\t\n",
      x_columns, mark);  // 13 lines
}

/// Two channels, F in N and x in m, 1 ms apart.
std::string segment_header(std::string_view between, const std::string& time = "10:45:47.5", int samples = 3,
                           const std::string& step = "0.001000") {
  return fmt::format(
      "Channels\t2\t\t\nSamples\t{2}{0}\t{2}\t\nDate\t2016/08/23{0}\t2016/08/23\t\nTime\t{1}{0}\t{1}\t\n"
      "Y_Unit_Label\tNewtons{0}\tm\t\nX_Dimension\tTime{0}\tTime\t\nX0\t0.0000000000000000E+0{0}\t"
      "0.0000000000000000E+0\t\nDelta_X\t{3}{0}\t{3}\t\n***End_of_Header***\t\t\t\n",
      between, time, samples, step);
}

std::string one_column() {
  return file_header("One") + segment_header("") +
         "X_Value\tF\tx\tComment\n0.000000\t1.5\t0.25\tstart of it\n0.001000\t2.5\t-0.5\n0.002000\t3.5\t0.125\n";
}

class LabviewMeasurement : public TextRecording {};

TEST_F(LabviewMeasurement, ReadsOneColumnOfXValues) {
  const auto recording = read(one_column(), columns_named({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_NEAR(recording->sampling_period, 1e-3, 1e-15);
  EXPECT_EQ(recording->channels[0].name, "F [N]");
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.5, 2.5, 3.5}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{0.25, -0.5, 0.125}));
  EXPECT_EQ(warnings_in(recording->remarks), 0U);
}

TEST_F(LabviewMeasurement, ReadsDecimalCommasWithoutXValues) {
  std::string segment = segment_header("");
  std::replace(segment.begin(), segment.end(), '.', ',');
  const auto recording =
      read(file_header("No", ',') + segment + "X_Value\tF\tx\tComment\n\t1,5\t0,25\n\t2,5\t-0,5\n\t3,5\t0,125\n",
           columns_named({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_NEAR(recording->sampling_period, 1e-3, 1e-15);
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.5, 2.5, 3.5}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{0.25, -0.5, 0.125}));
  EXPECT_TRUE(recording->doubts.empty());
}

TEST_F(LabviewMeasurement, ReadsAColumnOfXValuesForEach) {
  const std::string text = file_header("Multi") + segment_header("\t") + "X_Value\tF\tX_Value\tx\tComment\n" +
                           "0.000\t1\t0.000\t4\n0.001\t2\t0.001\t5\n0.002\t3\t\t\n";
  const auto recording = read(text, columns_named({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.0, 2.0}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{4.0, 5.0}));
  const auto contents = list_recording(write("a.lvm", text));
  ASSERT_EQ(contents->columns.size(), 4U);
  EXPECT_EQ(contents->columns[0].name, "time of F [s]");
  EXPECT_EQ(contents->columns[0].size, 3U);
  EXPECT_EQ(contents->columns[3].name, "x [m]");
  EXPECT_EQ(contents->columns[3].size, 2U);
}

// Without Decimal_Separator, as before version 2: as X0 and Delta_X are written.
TEST_F(LabviewMeasurement, FindsTheDecimalMarkWhereNoneIsStated) {
  for (const char mark : {'.', ','}) {
    std::string text = one_column();
    const std::size_t tag = text.find("Decimal_Separator");
    text.erase(tag, text.find('\n', tag) + 1 - tag);
    if (mark == ',') std::replace(text.begin(), text.end(), '.', ',');
    const auto recording = read(text, columns_named({"F", "x"}));
    ASSERT_TRUE(recording.has_value()) << recording.error().str();
    EXPECT_EQ(recording->channels[0].samples, (Samples{1.5, 2.5, 3.5}));
  }
}

TEST_F(LabviewMeasurement, ReadsCommasAsSeparator) {
  std::string text = one_column();
  std::replace(text.begin(), text.end(), '\t', ',');
  text.replace(text.find("Separator,Tab"), 13, "Separator,Comma");
  const auto recording = read(text, columns_named({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[1].samples, (Samples{0.25, -0.5, 0.125}));
}

// The second segment began 10 ms after the first: its samples lie there, and 7 are lost between.
TEST_F(LabviewMeasurement, SegmentsFollowByTheirDatesAndTimes) {
  const std::string rows = "X_Value\tF\tx\tComment\n\t1\t4\n\t2\t5\n\t3\t6\n";
  const auto recording =
      read(file_header("No") + segment_header("") + rows + "\n" + segment_header("", "10:45:47.510") + rows,
           columns_named({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  const Samples& force = recording->channels[0].samples;  // lost rows are filled in, and said
  ASSERT_EQ(force.size(), 13U);
  EXPECT_EQ(Samples(force.begin(), force.begin() + 3), (Samples{1, 2, 3}));
  EXPECT_EQ(Samples(force.end() - 3, force.end()), (Samples{1, 2, 3}));
  EXPECT_NEAR(recording->sampling_period, 1e-3, 1e-8);
  EXPECT_GE(warnings_in(recording->remarks) + recording->doubts.size(), 1U);
  const auto at_once = read(file_header("No") + segment_header("") + rows + segment_header("", "10:45:47.503") + rows,
                            columns_named({"F", "x"}));
  ASSERT_TRUE(at_once.has_value()) << at_once.error().str();
  EXPECT_EQ(at_once->channels[0].samples.size(), 6U);
  EXPECT_EQ(warnings_in(at_once->remarks), 0U);
}

TEST_F(LabviewMeasurement, RefusesSegmentsOfOtherColumns) {
  const auto recording =
      read(one_column() + "\n" + segment_header("", "10:45:48.5") + "X_Value\tF\ty\tComment\n0\t1\t2\n",
           columns_named({"F", "x"}));
  ASSERT_FALSE(recording.has_value());
  EXPECT_EQ(recording.error().place.line, 37U);
}

// Rows beyond what the header states come from later writes, and nothing says when.
TEST_F(LabviewMeasurement, RowsBeyondTheStatedSamplesAreADoubt) {
  const std::string text = file_header("No") + segment_header("", "10:45:47.5", 2) +
                           "X_Value\tF\tx\tComment\n\t1\t4\n\t2\t5\n\t3\t6\n\t4\t7\n";
  const auto recording = read(text, columns_named({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->doubts.size(), 1U);
  const auto settled = read(text, at_1_khz({"F", "x"}));
  ASSERT_TRUE(settled.has_value());
  EXPECT_TRUE(settled->doubts.empty());
}

TEST_F(LabviewMeasurement, ChannelsWithoutSamplesAndOfAnotherRateAreTold) {
  const std::string text =
      file_header("One") +
      "Channels\t3\nSamples\t4\t2\t0\nDate\t2016/08/11\t2016/08/11\t2016/08/"
      "11\nTime\t15:37:48.375\t15:37:48.375\t15:37:48.375\n"
      "X_Dimension\tTime\tTime\tTime\nX0\t0.0\t0.0\t0.0\nDelta_X\t0.001\t0.002\t1.0\n***End_of_Header***\n"
      "X_Value\tF\tslow\tnone\tComment\n0.000\t1\t5\t\n0.001\t2\t6\n0.002\t3\n0.003\t4\n";
  const auto slow = read(text, columns_named({"slow"}));
  ASSERT_TRUE(slow.has_value()) << slow.error().str();
  EXPECT_NEAR(slow->sampling_period, 2e-3, 1e-15);
  EXPECT_EQ(slow->channels[0].samples, (Samples{5.0, 6.0}));
  EXPECT_FALSE(read(text, columns_named({"F", "slow"})).has_value());
  EXPECT_FALSE(read(text, columns_named({"none"})).has_value());
  EXPECT_EQ(read(text, columns_named({"F"}))->channels[0].samples, (Samples{1.0, 2.0, 3.0, 4.0}));
}

TEST_F(LabviewMeasurement, PassesOverSpecialBlocks) {
  std::string text = one_column();
  text.insert(text.find("Channels"), "***Start_Special***\nBinary_Data\n12\t34\nX_Value\n***End_Special***\n");
  const auto recording = read(text, columns_named({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.5, 2.5, 3.5}));
}

TEST_F(LabviewMeasurement, AbsoluteXValuesKeepTheirDigits) {
  const auto recording = read(file_header("One") + segment_header("") +
                                  "X_Value\tF\tx\n3554707547.500\t1\t4\n3554707547.501\t2\t5\n3554707547.502\t3\t6\n",
                              columns_named({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_NEAR(recording->sampling_period, 1e-3, 1e-6);
}

// Each channel's X values count from its own date and time.
TEST_F(LabviewMeasurement, ChannelsThatBeginLaterLieLater) {
  const auto with_second_at = [&](const std::string& time) {
    std::string text = file_header("Multi") + segment_header("\t") + "X_Value\tF\tX_Value\tx\tComment\n" +
                       "0.000\t1\t0.000\t4\n0.001\t2\t0.001\t5\n0.002\t3\t0.002\t6\n";
    text.replace(text.rfind("10:45:47.5"), 10, time);
    return read(text, columns_named({"F", "x"}));
  };
  const auto at_once = with_second_at("10:45:47.5");
  ASSERT_TRUE(at_once.has_value()) << at_once.error().str();
  EXPECT_EQ(at_once->channels[0].samples, (Samples{1.0, 2.0, 3.0}));
  EXPECT_EQ(warnings_in(at_once->remarks), 0U);
  const auto scanned = with_second_at("10:45:47.500014");
  ASSERT_TRUE(scanned.has_value()) << scanned.error().str();
  EXPECT_EQ(scanned->channels[1].samples, (Samples{4.0, 5.0, 6.0}));
  EXPECT_EQ(warnings_in(scanned->remarks), 1U);
  const auto later = with_second_at("10:45:47.501");
  ASSERT_TRUE(later.has_value()) << later.error().str();
  EXPECT_EQ(later->channels[0].samples, (Samples{2.0, 3.0}));
  EXPECT_EQ(later->channels[1].samples, (Samples{4.0, 5.0}));
  EXPECT_FALSE(with_second_at("10:45:47.5004").has_value());
  EXPECT_FALSE(with_second_at("10:45:48.5").has_value());
}

TEST_F(LabviewMeasurement, XThatIsNoTimeIsNone) {
  std::string text = one_column();
  text.replace(text.find("X_Dimension\tTime\tTime"), 21, "X_Dimension\tFrequency\tFrequency");
  EXPECT_FALSE(read(text, columns_named({"F", "x"})).has_value());
  EXPECT_TRUE(read(text, at_1_khz({"F", "x"})).has_value());
}

TEST_F(LabviewMeasurement, LeavesOutALastRowThatIsCutOff) {
  const auto recording = read(one_column() + "0.003\t4", columns_named({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.5, 2.5, 3.5}));
  EXPECT_EQ(warnings_in(recording->remarks), 1U);
}

TEST_F(LabviewMeasurement, RefusesDamageWithItsLine) {
  const auto line = [&](const std::string& text) {
    const auto recording = read(text, columns_named({"F", "x"}));
    return recording ? 0U : recording.error().place.line;
  };
  const std::string good = one_column();  // 13 + 9 + 1 + 3 lines
  EXPECT_EQ(line(good + "0.003\ta\t2\n"), 27U);
  EXPECT_EQ(line(good + "later\t1\t2\n"), 27U);
  EXPECT_EQ(line(good + "\t1\t2\n"), 27U);
  EXPECT_EQ(line(file_header("One") + "0.0\t1\t2\n0.1\t1\t2\n"), 14U);
  EXPECT_EQ(line(file_header("Multi") + segment_header("\t") + "X_Value\tF\tx\n0\t1\t2\n"), 23U);
  EXPECT_EQ(line(file_header("No") + segment_header("", "10:45:47.5", 3, "0") + "X_Value\tF\tx\n\t1\t2\n\t2\t3\n"),
            23U);
  EXPECT_FALSE(read(file_header("One"), columns_named({"F"})).has_value());
  EXPECT_FALSE(read(file_header("One") + segment_header(""), columns_named({"F"})).has_value());
  EXPECT_FALSE(read("LabVIEW Measurement", columns_named({"F"})).has_value());
  EXPECT_EQ(read(file_header("One", '!') + segment_header(""), columns_named({"F"})).error().place.line, 5U);
}

TEST_F(LabviewMeasurement, AnyBeginningIsReadOrRefused) {
  const std::string text = one_column();
  const Samples all{1.5, 2.5, 3.5};
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
