#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "io/recording_folder.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
namespace {

TEST_F(TextRecording, RefusesMoreThanAHundredthMissing) {
  EXPECT_EQ(refusal("F,x\n1,2\n#\nnan,2\n3,4\n", at_1_khz({"F"})),
            "4:1: F: too_many_samples_missing missing=1 samples=3");
  EXPECT_EQ(refusal("F,x\n,2\n,4\n", at_1_khz({"F"})), "2:1: F: too_many_samples_missing missing=2 samples=2");
}

TEST_F(TextRecording, RefusesCellsThatAreNoNumbers) {
  const auto cell = [&](const std::string& text) {
    return refusal("F;x\n1.5;2\n" + text + ";3\n1.5;2\n", at_1_khz({"F"}));
  };
  const auto no_number = [](const std::string& text, const std::string& why = "") {
    return "F: no_number_in_cell cell=\"" + text + "\" decimal_mark=." + why;
  };
  EXPECT_EQ(cell("0x1F"), "3:1: " + no_number("0x1F", " why=hexadecimal"));
  EXPECT_EQ(cell("abc"), "3:1: " + no_number("abc"));
  EXPECT_EQ(cell("1.5e"), "3:1: " + no_number("1.5e"));
  EXPECT_EQ(cell("1.5 N"), "3:1: " + no_number("1.5 N"));
  EXPECT_EQ(cell("+-1"), "3:1: " + no_number("+-1"));
  EXPECT_EQ(cell("1e999"), "3:1: " + no_number("1e999", " why=range"));
  EXPECT_EQ(cell("-1e300"), "3:1: F: sample_too_large value=-1e+300");
  EXPECT_EQ(cell("1.5D-3"), "3:1: " + no_number("1.5D-3", " why=fortran"));
  EXPECT_EQ(cell("1,234.5"), "3:1: " + no_number("1,234.5", " why=thousands"));
  EXPECT_EQ(cell("1,5"), "3:1: " + no_number("1,5", " why=decimal_mark"));
  EXPECT_EQ(cell("   x"), "3:4: " + no_number("x"));
}

TEST_F(TextRecording, RefusesRowsOfAnotherLength) {
  EXPECT_EQ(refusal("t,F\n0,1\n1\n2,3\n3,4\n", columns_named({"F"})),
            "3:1: wrong_number_of_cells cells=1 expected=2 as=header");
  EXPECT_EQ(refusal("0,1\n1,2,3\n2,3\n3,4\n", at_1_khz({"1"})),
            "2:1: wrong_number_of_cells cells=3 expected=2 rows=1 as=most_lines");
}

TEST_F(TextRecording, NamesTheColumnsWhereOneIsMissing) {
  EXPECT_EQ(refusal("t,force [N],x\n0,1,2\n1,2,3\n", columns_named({"froce"})),
            "froce: no_such_column columns=3 names=t, force [N], x meant=force");
  EXPECT_EQ(refusal("0,1\n1,2\n", at_1_khz({"3"})), "3: no_such_column columns=2 names=1, 2");
  EXPECT_EQ(refusal("F,F\n0,1\n1,2\n", at_1_khz({"F"})), "F: column_name_not_unique columns=2 numbers=1, 2");
  EXPECT_EQ(refusal("a,b\n0,1\n1,2\n", columns_named({"a"})), "no_times columns=2 names=a, b");
}

TEST_F(TextRecording, RefusesATimeOfDay) {
  EXPECT_EQ(refusal("time,F\n12:30:01,1\n12:30:02,2\n", columns_named({"F"})),
            "2:1: time: no_number_in_cell cell=\"12:30:01\" decimal_mark=. why=time_of_day as=time");
  EXPECT_TRUE(read("time,F\n12:30:01,1\n12:30:02,2\n", at_1_khz({"F"})).has_value());
}

TEST_F(TextRecording, RefusesATimeBesideARate) {
  RecordingOptions options = at_1_khz({"F"});
  options.time_column = "t";
  EXPECT_EQ(refusal("t,F\n0,1\n1,2\n", options), "t: asked_for_beside of=times");
}

TEST_F(TextRecording, RefusesWhatIsNoTable) {
  const RecordingOptions options = at_1_khz({"1"});
  EXPECT_EQ(refusal("", options), "no_rows_of_numbers lines=0");
  EXPECT_EQ(refusal("\n \n", options), "no_rows_of_numbers lines=2");
  EXPECT_EQ(refusal("# a\n# b\n", options), "no_rows_of_numbers lines=2");
  EXPECT_EQ(refusal("t,F,x\n", options), "no_rows_of_numbers lines=1 beginning=\"t,F,x\"");
  EXPECT_EQ(refusal("Dear all,\nthe rig is broken.\n", options), "no_rows_of_numbers lines=2 beginning=\"Dear all,\"");
  EXPECT_EQ(refusal(std::string_view("\xFF\xFEt\0,\0", 6), options), "no_text_table kind=utf16");
  EXPECT_EQ(refusal(std::string_view("1,2\0\n", 5), options), "no_text_table kind=binary");
  EXPECT_EQ(refusal("PK\x03\x04...", options), "no_text_table kind=sheet");
  EXPECT_EQ(refusal("F,x\r1,2\r3,4\r", options), "no_text_table kind=carriage_returns");
  const auto long_line = read("x\n1\n" + std::string(6 << 20, '1') + "\n", options);
  ASSERT_FALSE(long_line);
  EXPECT_EQ(long_line.error().place.line, 3U);
}

TEST_F(TextRecording, RefusesWhatIsNoFile) {
  const auto message = [](const std::string& file) {
    const auto recording = read_recording(file, at_1_khz({"1"}));
    return recording ? "read" : recording.error().str();
  };
  EXPECT_EQ(message(path("")), path("") + ": is a directory; must be a recording");
  EXPECT_EQ(message(path("none")), path("none") +
                                       ": cannot be read: No such file or directory; must be a readable "
                                       "recording, or \"-\" for standard input");
  EXPECT_EQ(message("/dev/zero"),
            "/dev/zero: is neither a file nor a pipe; must be a recording, or \"-\" for standard input");
  EXPECT_EQ(message(""), "\"\": is no file name; must be a recording, or \"-\" for standard input");
}

TEST_F(TextRecording, RefusesBugsOfTheCaller) {
  const std::string file = write("a.csv", "1,2\n3,4\n");
  EXPECT_THROW((void)read_recording(file, RecordingOptions{}), Error);
  RecordingOptions options = at_1_khz({"1"});
  options.columns[0].scale = std::nan("");
  EXPECT_THROW((void)read_recording(file, options), Error);
  options.columns[0].scale = 1.0;
  options.rate = -1.0;
  EXPECT_THROW((void)read_recording(file, options), Error);
}

}  // namespace
}  // namespace zwidth
