// The words of what is wrong with MAT files and universal files, from codes and numbers.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "counted.hpp"
#include "uff_function_name.hpp"
#include "zwidth/input_problem.hpp"

namespace zwidth {
using namespace internal;
namespace {

/// "what; allowed"
std::string told_of_file(Problem problem) { return input_problem({}, std::move(problem)).str(); }

TEST(MatUffProblemText, SaysWhereAFileIsDamaged) {
  Problem problem{.code = ProblemCode::bytes_missing, .evidence = {counted("bytes", 24), counted("left", 21)}};
  EXPECT_EQ(told_of_file(problem), "24 bytes are announced, 21 are left; save or copy the file again");
  problem.evidence.push_back(counted("byte", 208));
  EXPECT_EQ(told_of_file(problem),
            "is damaged at byte 208: 24 bytes are announced, 21 are left; save or copy the file again");
  problem.evidence = {counted("bytes", 24), counted("left", 21), counted("points", 3), counted("declared", 24)};
  EXPECT_EQ(told_of_file(problem),
            "3 points take 24 bytes, 21 are left; the header says 24 bytes: the file may be cut off or damaged");
}

TEST(MatUffProblemText, SaysWhatANumberOfAHeaderMustBe) {
  const auto field = [](std::string name) {
    return told_of_file({.code = ProblemCode::wrong_field,
                         .evidence = {{"value", -1.0}, {"most", 128.0}},
                         .subjects = {{"field", std::move(name)}}});
  };
  EXPECT_EQ(field("byte order"), "the byte order is -1; must be 1 (little-endian) or 2 (big-endian)");
  EXPECT_EQ(field("number format"),
            "the number format is -1; must be 2 (IEEE 754): export the file as text, dataset 58");
  EXPECT_EQ(field("header length"), "the header length is -1; must be 11 lines");
  EXPECT_EQ(field("size"), "the size is -1; must be 0 or more");
  EXPECT_EQ(field("name length"), "the name length is -1; must be 1 to 128 bytes");
}

TEST(MatUffProblemText, SaysWhatIsThereAndWhatIsWanted) {
  const auto kind = [](std::string what, std::string wanted) {
    return told_of_file(
        {.code = ProblemCode::wrong_kind,
         .subjects = {{"kind", std::move(what)}, {"wanted", std::move(wanted)}, {"choices", "a.1 to a.3"}}});
  };
  EXPECT_EQ(kind("a cell array", "array"), "is a cell array; must be a real numeric array");
  EXPECT_EQ(kind("a matrix", "column"), "is a matrix; must be one of them: a.1 to a.3");
  EXPECT_EQ(kind("a coherence", "times"), "is a coherence; must be a real time record (function type 1)");
  EXPECT_EQ(
      told_of_file(
          {.code = ProblemCode::wrong_kind, .evidence = {counted("class", 23)}, .subjects = {{"wanted", "array"}}}),
      "is of the unknown class 23; must be a real numeric array");
}

TEST(MatUffProblemText, SaysWhatAFileHoldsInstead) {
  const auto none = [](std::string wanted, std::string_view name, std::string text) {
    return told_of_file(
        {.code = ProblemCode::holds_none, .subjects = {{"wanted", std::move(wanted)}, {name, std::move(text)}}});
  };
  EXPECT_EQ(told_of_file({.code = ProblemCode::holds_none, .subjects = {{"wanted", "signals"}}}),
            "holds no signals; must hold numeric arrays of two samples at least");
  EXPECT_EQ(none("signals", "others", "note (is text)"),
            "holds no signals, only note (is text); must hold numeric arrays of two samples at least");
  EXPECT_EQ(none("signals", "objects", "ts"),
            "holds no signals, only MATLAB objects: ts; must hold numeric arrays: take the data out of tables and "
            "timeseries and save them as vectors");
  EXPECT_EQ(none("function", "datasets", "164"), "holds no function, only datasets 164; must hold dataset 58 (or 58b)");
  EXPECT_EQ(none("frequency response", "others", "x (coherence)"),
            "holds no frequency response, only x (coherence); must hold a complex record of function type 4");
}

TEST(MatUffProblemText, SaysWhatIsTooMuch) {
  Problem values{
      .code = ProblemCode::has_too_many, .evidence = {counted("most", 100)}, .subjects = {{"what", "values"}}};
  EXPECT_EQ(told_of_file(values), "has more than 100 values; at most 100 in an array");
  values.evidence.push_back(counted("value", 101));
  EXPECT_EQ(told_of_file(values), "has 101 values; at most 100 in an array");
  EXPECT_EQ(told_of_file(
                {.code = ProblemCode::has_too_many, .evidence = {counted("most", 2)}, .subjects = {{"what", "GiB"}}}),
            "has more than 2 GiB; must be split into several files");
}

TEST(MatUffProblemText, NamesOptionsAndTheRatesOfTheFile) {
  const InputProblem problem = input_problem(
      {}, {.code = ProblemCode::no_times, .evidence = {counted("samples", 2)}, .subjects = {{"rates", "fs = 2500"}}});
  EXPECT_EQ(problem.what, "has no column of 2 samples whose name says time");
  ASSERT_EQ(problem.options_of_allowed.size(), 2U);
  EXPECT_EQ(problem.options_of_allowed[0].name, "rate");
  EXPECT_EQ(problem.options_of_allowed[1].name, "time_column");
  EXPECT_TRUE(problem.allowed.ends_with("; the file has fs = 2500")) << problem.allowed;
}

TEST(MatUffProblemText, NamesTheFunctionTypes) {
  EXPECT_EQ(uff_function_name(1), "time response");
  EXPECT_EQ(uff_function_name(4), "frequency response");
  EXPECT_EQ(uff_function_name(28), "phase compensation");
  EXPECT_EQ(uff_function_name(29), "function of type 29");
  EXPECT_EQ(uff_function_name(-1), "function of type -1");
}

}  // namespace
}  // namespace zwidth
