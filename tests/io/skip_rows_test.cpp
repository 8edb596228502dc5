// Tables below headers of several lines: what is metadata is no sample, and `skip_rows` passes over what is not known.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/recording_folder.hpp"
#include "zwidth/io/recorded_columns.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
namespace {

using Samples = std::vector<double>;

class SkippedRows : public TextRecording {
 protected:
  static RecordingOptions skipping(std::size_t rows, RecordingOptions options) {
    options.skip_rows = rows;
    return options;
  }
};

TEST_F(SkippedRows, TheTableBeginsBelowThem) {
  const std::string text = "Rig 7\n1;2;3;4\n5;6;7;8\nt;F;x\n0;1,5;2\n0,001;2,5;3\n0,002;3,5;4\n";
  const auto recording = read(text, skipping(3, columns_named({"F", "x"})));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.5, 2.5, 3.5}));
  const auto unnamed = read(text, skipping(4, at_1_khz({"2"})));
  ASSERT_TRUE(unnamed.has_value()) << unnamed.error().str();
  EXPECT_EQ(unnamed->channels[0].samples, (Samples{1.5, 2.5, 3.5}));
  const auto contents = list_recording(write("a.csv", text), skipping(3, {}));
  ASSERT_TRUE(contents.has_value());
  EXPECT_EQ(contents->columns[1].name, "F");
}

TEST_F(SkippedRows, LinesKeepTheirNumbers) {
  const auto recording = read("a\nb\nt,F\n0,1\n1,b\n2,3\n", skipping(2, columns_named({"F"})));
  ASSERT_FALSE(recording.has_value());
  EXPECT_EQ(recording.error().place.line, 5U);
}

TEST_F(SkippedRows, MoreThanTheFileHasAreRefused) {
  const auto recording = read("t,F\n0,1\n1,2\n", skipping(4, columns_named({"F"})));
  ASSERT_FALSE(recording.has_value());
  EXPECT_EQ(data_of(recording.error()), "skipped rows: too_many_rows_skipped rows=4 lines=3");
  EXPECT_FALSE(read("t,F\n0,1\n1,2\n", skipping(3, columns_named({"F"}))).has_value());
}

TEST_F(SkippedRows, AnExportIsReadAsATable) {
  const std::string text = "Name\tScope\t\nFile\ta.csv\t\nName\tF\tx\nUnit\tN\tm\n0\t1,5\t2\n1\t2,5\t3\n2\t3,5\t4\n";
  const auto recording = read(text, skipping(4, at_1_khz({"2", "3"})));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_EQ(recording->channels[0].name, "2");
  EXPECT_EQ(recording->channels[0].samples, (Samples{1.5, 2.5, 3.5}));
}

// The header of a program that is not known: its numbers were samples as long as the column of words was not asked for.
std::string labelled(std::string_view label) {
  std::string text = "Signal;F;x\nUnit;N;m\nFactor;2;0,5\nOffset;10;20\n";
  for (int i = 0; i < 6; ++i) text += fmt::format("{}{};{},5;{}\n", label, i, i, 2 * i);
  return text;
}

TEST_F(SkippedRows, ALineOfMetadataIsNoSample) {
  const auto recording = read(labelled(""), at_1_khz({"F", "x"}));
  ASSERT_FALSE(recording.has_value());
  EXPECT_EQ(data_of(recording.error()), "3:1: Unit: no_number_in_cell line=4 cell=\"Factor\" decimal_mark=, as=header");
  const auto skipped = read(labelled(""), skipping(4, at_1_khz({"2", "3"})));
  ASSERT_TRUE(skipped.has_value()) << skipped.error().str();
  EXPECT_EQ(skipped->channels[0].samples, (Samples{0.5, 1.5, 2.5, 3.5, 4.5, 5.5}));
}

TEST_F(SkippedRows, NorIsOneThatBeginsWithAnEmptyCell) {
  const std::string text = "t;F;x\ns;N;m\n;2;0,5\n0;1;2\n1;2;3\n2;3;4\n3;4;5\n";
  const auto recording = read(text, at_1_khz({"F", "x"}));
  ASSERT_FALSE(recording.has_value());
  EXPECT_EQ(data_of(recording.error()), "3:1: t [s]: no_number_in_cell line=3 cell=\"\" decimal_mark=, as=header");
  // Where rows may begin with nothing, and where the number is missing elsewhere, it is one.
  EXPECT_TRUE(read("x;F\n;1\n1;2\n;3\n2;3\n;4\n", at_1_khz({"F"})).has_value());
  EXPECT_TRUE(read("t;F;x\n0;1;\n1;2;3\n2;3;4\n3;4;5\n", at_1_khz({"F"})).has_value());
}

TEST_F(SkippedRows, WhatIsNoTableProposesThem) {
  const auto options = [&](const std::string& text) { return read(text, at_1_khz({"1"})).error().options_of_allowed; };
  for (const char* text : {"Dear all,\nthe rig is broken.\n", "0,1\n1,2,3\n2,3\n3,4\n"}) {
    ASSERT_EQ(options(text).size(), 1U) << text;
    EXPECT_EQ(options(text)[0].name, "skip_rows");
  }
}

// --- Columns in memory with times of their own.

RecordedColumns two_clocks(const Samples& second_times) {
  RecordedColumns recorded;
  recorded.source = "memory";
  recorded.columns = {
      {"t1 [ms]", {0.0, 1.0, 2.0, 3.0}, {}}, {"F", {1.0, 2.0, 3.0, 4.0}, 0}, {"t2 [s]", second_times, {}}};
  Samples values;
  for (std::size_t i = 0; i < second_times.size(); ++i) values.push_back(10.0 * static_cast<double>(i));
  recorded.columns.push_back({"x", values, 2});
  return recorded;
}

TEST(ColumnsWithTimes, ArePutTogetherByThem) {
  const auto recording = read_recording(two_clocks({0.001, 0.002, 0.003, 0.004, 0.005}), columns_named({"F", "x"}));
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  EXPECT_NEAR(recording->sampling_period, 1e-3, 1e-15);
  EXPECT_EQ(recording->channels[0].samples, (Samples{2.0, 3.0, 4.0}));
  EXPECT_EQ(recording->channels[1].samples, (Samples{0.0, 10.0, 20.0}));
}

TEST(ColumnsWithTimes, AreOneWhereStampsAreRoundedOtherwise) {
  EXPECT_TRUE(read_recording(two_clocks({0.0, 0.0010000004, 0.002, 0.003}), columns_named({"F", "x"})).has_value());
  EXPECT_FALSE(read_recording(two_clocks({0.0, 0.00101, 0.002, 0.003}), columns_named({"F", "x"})).has_value());
}

TEST(ColumnsWithTimes, AreRefusedWhereTheyDiffer) {
  const auto refused = [](const Samples& times) {
    const auto recording = read_recording(two_clocks(times), columns_named({"F", "x"}));
    return recording ? std::string() : recording.error().place.key;
  };
  EXPECT_EQ(refused({0.0005, 0.0015, 0.0025}), "x");          // between each other
  EXPECT_EQ(refused({0.0, 0.002}), "x");                      // another rate
  EXPECT_EQ(refused({0.0, 0.001, 0.003}), "x");               // a row that one lacks
  EXPECT_FALSE(refused({0.003, 0.004, 0.005}).empty());       // one row in common
  EXPECT_FALSE(refused({1.0, 1.001, 1.002, 1.003}).empty());  // none
}

TEST(ColumnsWithTimes, MustNameTheirColumn) {
  RecordedColumns recorded = two_clocks({0.0, 0.001, 0.002});
  recorded.columns[3].time_column = 7;
  ASSERT_TRUE(find_problem(recorded).has_value());
  EXPECT_EQ(find_problem(recorded)->place.key, "x");
  recorded.columns[3].time_column = 0;  // four times, three samples
  EXPECT_TRUE(find_problem(recorded).has_value());
  EXPECT_FALSE(find_problem(two_clocks({0.0, 0.001, 0.002})).has_value());
}

}  // namespace
}  // namespace zwidth
