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
            "4:1: F: is NaN, infinite or empty, the first of 1 such samples among 3; at most 1 % may be missing");
  EXPECT_EQ(refusal("F,x\n,2\n,4\n", at_1_khz({"F"})),
            "2:1: F: is NaN, infinite or empty, the first of 2 such samples among 2; at most 1 % may be missing");
}

TEST_F(TextRecording, RefusesCellsThatAreNoNumbers) {
  const auto cell = [&](const std::string& text) {
    const std::string message = refusal("F;x\n1.5;2\n" + text + ";3\n1.5;2\n", at_1_khz({"F"}));
    return message.substr(0, message.find(';'));
  };
  EXPECT_EQ(cell("0x1F"), "3:1: F: \"0x1F\" is hexadecimal");
  EXPECT_EQ(cell("abc"), "3:1: F: \"abc\" is no number");
  EXPECT_EQ(cell("1.5e"), "3:1: F: \"1.5e\" is no number");
  EXPECT_EQ(cell("1.5 N"), "3:1: F: \"1.5 N\" is no number");
  EXPECT_EQ(cell("+-1"), "3:1: F: \"+-1\" is no number");
  EXPECT_EQ(cell("1e999"), "3:1: F: \"1e999\" is too large");
  EXPECT_EQ(cell("-1e300"), "3:1: F: is -1e+300");
  EXPECT_EQ(cell("1.5D-3"), "3:1: F: \"1.5D-3\" has the exponent of Fortran");
  EXPECT_EQ(cell("1,234.5"), "3:1: F: \"1,234.5\" groups its thousands");
  EXPECT_EQ(cell("1,5"), "3:1: F: \"1,5\" is no number: the decimal mark is a point");
  EXPECT_EQ(cell("   x"), "3:4: F: \"x\" is no number");
}

TEST_F(TextRecording, RefusesRowsOfAnotherLength) {
  EXPECT_EQ(refusal("t,F\n0,1\n1\n2,3\n3,4\n", columns_named({"F"})),
            "3:1: has 1 cell; must have 2 cells as the header has");
  EXPECT_EQ(refusal("0,1\n1,2,3\n2,3\n3,4\n", at_1_khz({"1"})),
            "2:1: has 3 cells; must have 2 cells as most of the first lines have; lines of a header can be passed over "
            "(`skip_rows`)");
}

TEST_F(TextRecording, NamesTheColumnsWhereOneIsMissing) {
  EXPECT_EQ(refusal("t,force [N],x\n0,1,2\n1,2,3\n", columns_named({"froce"})),
            " froce: no such column; did you mean \"force\"? the file has 3 columns: t, force [N], x");
  EXPECT_EQ(refusal("0,1\n1,2\n", at_1_khz({"3"})), " 3: no such column; the file has 2 columns: 1, 2");
  EXPECT_EQ(refusal("F,F\n0,1\n1,2\n", at_1_khz({"F"})),
            " F: 2 columns have this name; must be one of their numbers: 1, 2");
  EXPECT_EQ(
      refusal("a,b\n0,1\n1,2\n", columns_named({"a"})),
      " has no column whose name says time; state the rate in Hz (`rate`) or the column of times (`time_column`); the "
      "file has 2 columns: a, b");
}

TEST_F(TextRecording, RefusesATimeOfDay) {
  EXPECT_EQ(refusal("time,F\n12:30:01,1\n12:30:02,2\n", columns_named({"F"})),
            "2:1: time: \"12:30:01\" is a time of day; times must be numbers, such as seconds from the start; or state "
            "the rate instead (`rate`)");
  EXPECT_TRUE(read("time,F\n12:30:01,1\n12:30:02,2\n", at_1_khz({"F"})).has_value());
}

TEST_F(TextRecording, RefusesATimeBesideARate) {
  RecordingOptions options = at_1_khz({"F"});
  options.time_column = "t";
  EXPECT_EQ(refusal("t,F\n0,1\n1,2\n", options),
            " t: a column of times is asked for beside a rate; must be one of the two");
}

TEST_F(TextRecording, RefusesWhatIsNoTable) {
  const RecordingOptions options = at_1_khz({"1"});
  EXPECT_EQ(refusal("", options), " is empty; must be a recording");
  EXPECT_EQ(refusal("\n \n", options),
            " has comments or empty lines only; must be a table with a row of numbers for each sample");
  EXPECT_EQ(refusal("# a\n# b\n", options),
            " has comments or empty lines only; must be a table with a row of numbers for each sample");
  const std::string table =
      "; must be a table: columns of numbers separated by commas, semicolons, tabs or blanks, below a header that may "
      "be "
      "passed over (`skip_rows`)";
  EXPECT_EQ(refusal("t,F,x\n", options), " has one line, \"t,F,x\", and no row of numbers" + table);
  EXPECT_EQ(refusal("Dear all,\nthe rig is broken.\n", options),
            " has no rows of numbers; it begins with \"Dear all,\"" + table);
  EXPECT_EQ(refusal(std::string_view("\xFF\xFEt\0,\0", 6), options),
            " is text in UTF-16; must be UTF-8 or ASCII: convert it with iconv -f UTF-16 -t UTF-8");
  EXPECT_EQ(refusal(std::string_view("1,2\0\n", 5), options),
            " is binary data; must be a text table, a MAT file (v5 or v7.3) or a UFF file (dataset 58)");
  EXPECT_EQ(refusal("PK\x03\x04...", options),
            " is a ZIP archive or a spreadsheet; must be a recording: save the sheet as CSV");
  EXPECT_EQ(refusal("F,x\r1,2\r3,4\r", options),
            " ends its lines with a carriage return alone; must end them with a line feed, before it or not");
  EXPECT_EQ(refusal("x\n1\n" + std::string(6 << 20, '1') + "\n", options),
            "3:1: the line is longer than 4 MiB; must be a table of numbers with a line for each sample");
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
