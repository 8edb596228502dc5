// The words of what is wrong with a recording or a response as text.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "zwidth/input_problem.hpp"

namespace zwidth {
namespace {

using internal::counted;

struct Told {
  Problem problem;
  std::string line;  ///< "what; allowed"
};

TEST(RecordingProblemText, SaysWhatIsWrongAndWhatToDo) {
  using enum ProblemCode;
  const std::vector<Told> all{
      {{.code = no_text_table, .subjects = {{"kind", "utf16"}}},
       "is text in UTF-16; must be a text table in UTF-8 or ASCII: convert it with iconv -f UTF-16 -t UTF-8"},
      {{.code = no_rows_of_numbers, .evidence = {counted("lines", 0)}},
       "is empty; must be a table: columns of numbers separated by commas, semicolons, tabs or blanks, below a header "
       "that may be passed over (`skip_rows`)"},
      {{.code = no_rows_of_numbers, .evidence = {counted("lines", 2)}, .subjects = {{"beginning", "\"Dear all,\""}}},
       "has no rows of numbers; it begins with \"Dear all,\"; must be a table: columns of numbers separated by commas, "
       "semicolons, tabs or blanks, below a header that may be passed over (`skip_rows`)"},
      {{.code = no_such_column,
        .evidence = {counted("columns", 3)},
        .subjects = {{"names", "t, force [N], x"}, {"meant", "force"}}},
       "no such column; did you mean \"force\"? the file has 3 columns: t, force [N], x"},
      {{.code = no_columns, .evidence = {counted("asked", 0)}}, "no columns are asked for; name one at least"},
      {{.code = too_few_samples, .evidence = {counted("samples", 1)}}, "has 1 sample; must have two at least"},
      {{.code = wrong_number_of_cells,
        .evidence = {counted("cells", 1), counted("expected", 2)},
        .subjects = {{"as", "header"}}},
       "has 1 cell; must have 2 cells as the header has"},
      {{.code = wrong_number_of_cells,
        .evidence = {counted("cells", 3), counted("expected", 2), counted("rows", 0)},
        .subjects = {{"as", "most_lines"}}},
       "has 3 cells; must have 2 cells as most of the first lines have; lines of a header can be passed over "
       "(`skip_rows`)"},
      {{.code = line_without_header, .subjects = {{"format", "controldesk"}}},
       "is a line without a section above it; must follow the line that begins with \"trace_values\""},
      {{.code = no_number_in_cell, .subjects = {{"cell", "\"1,5\""}, {"decimal_mark", "."}, {"why", "decimal_mark"}}},
       "\"1,5\" is no number: the decimal mark is a point; must be a number such as -1.5e-3"},
      {{.code = no_number_in_cell,
        .evidence = {counted("line", 4)},
        .subjects = {{"cell", "\"Factor\""}, {"decimal_mark", ","}, {"as", "header"}}},
       "\"Factor\" is no number; must be a number; where the line is part of a header, pass over all of it "
       "(`skip_rows` "
       "4)"},
      {{.code = no_number_in_cell, .subjects = {{"cell", "\"3\""}, {"as", "complex"}}},
       "\"3\" is no complex number; must be one such as (1.5+2e-3j); or name magnitude and phase, or real and "
       "imaginary "
       "part"},
      {{.code = sample_too_large, .evidence = {{"value", 1e200}, {"scale", 2.0}, counted("sample", 7)}},
       "sample 7: is 1e+200 with the scale 2; must be below 1e100 in magnitude, as any force and motion is; a damaged "
       "cell?"},
      {{.code = times_not_rising, .evidence = {{"time", 65304.0}, {"after", 778.0}, counted("bits", 16)}},
       "the time falls from 65304 to 778; times must rise: this looks like a timer of 16 bits that wraps (`timer_bits` "
       "16)"},
      {{.code = times_not_rising, .evidence = {{"time", 0.001}, counted("times", 2), counted("sample", 3)}},
       "sample 3: the time stands still at 0.001, 2 times in the record; times must rise: where they have too few "
       "digits or are repeated, state the rate instead (`rate`)"},
      {{.code = no_response_column, .subjects = {{"names", "f, mag, x"}, {"quantity", "phase"}}},
       "the phase has no column; name it; the columns are f, mag, x"},
      {{.code = frequency_out_of_range, .evidence = {{"hertz", 40.0}, {"lowest", 50.0}}},
       "is 40 Hz; must be above the lowest, 50 Hz"},
      {{.code = frequency_out_of_range, .evidence = {{"hertz", -20.0}}}, "is -20 Hz; must be finite and above 0"},
  };
  for (const Told& each : all) {
    const InputProblem told = input_problem({}, each.problem);
    EXPECT_EQ(told.what + "; " + told.allowed, each.line);
  }
}

// Bytes of a file stand in a sentence as they are: none ends it, and none names an option.
TEST(RecordingProblemText, HoldsWhateverACellHolds) {
  using namespace std::string_literals;
  const InputProblem told = input_problem(
      {}, {.code = ProblemCode::no_number_in_cell, .subjects = {{"cell", "\"\0`rate`\x1a\""s}, {"decimal_mark", "."}}});
  EXPECT_EQ(told.what, "\"\0`rate`\x1a\" is no number"s);
  EXPECT_TRUE(told.options_of_what.empty());
  EXPECT_EQ(told.str(), "\"\\x00`rate`\\x1A\" is no number; must be a number such as -1.5e-3");
}

TEST(RecordingProblemText, NamesTheOptionThatPassesOverAHeader) {
  const InputProblem told = input_problem({}, {.code = ProblemCode::no_number_in_cell,
                                               .evidence = {counted("line", 4)},
                                               .subjects = {{"cell", "\"`rate`\""}, {"as", "header"}}});
  EXPECT_TRUE(told.options_of_what.empty());
  ASSERT_EQ(told.options_of_allowed.size(), 1U);
  EXPECT_EQ(told.options_of_allowed[0].name, "skip_rows");
}

}  // namespace
}  // namespace zwidth
