// Options that a sentence names are fields of it: each front puts its own names there.

#include "zwidth/option_text.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "zwidth/input_problem.hpp"

namespace zwidth {
namespace {

std::optional<std::string> in_capitals(const std::string& name) {
  if (name == "skip_rows") return "S";
  if (name == "rate") return "--sampling-rate";
  return std::nullopt;
}

TEST(OptionText, OnlyALiteralNamesOptions) {
  const OptionText literal = "pass it over (`skip_rows` 3), or `rate`";
  ASSERT_EQ(literal.options.size(), 2U);
  EXPECT_EQ(literal.options[0].name, "skip_rows");
  EXPECT_EQ(literal.text.substr(literal.options[1].at, literal.options[1].length), "`rate`");
  EXPECT_TRUE(OptionText(std::string("a column called `rate`")).options.empty());
  EXPECT_TRUE(OptionText("one quote ` and `Two Words`").options.empty());
}

TEST(OptionText, EachIsCalledByAFrontsName) {
  const std::string of_a_user = "`rate` has no unit: ";
  InputProblem error{{.file = "a.csv"}, "is short", "", {}};
  error.allow(OptionText(of_a_user) + "state `rate`, `skip_rows` or `header`" + std::string(" of `rate`"));
  error.name_options(in_capitals);
  EXPECT_EQ(error.allowed, of_a_user + "state --sampling-rate, S or `header` of `rate`");
  // As a second front does it, on the names of the first.
  error.name_options([](const std::string& name) -> std::optional<std::string> { return name + "!"; });
  EXPECT_EQ(error.allowed, of_a_user + "state --sampling-rate!, S! or header! of `rate`");
}

TEST(OptionText, StaysInPlaceBehindAnotherBeginning) {
  InputProblem problem{{}, "", "", {}};
  const OptionText sentence = "is not for `rate`";
  problem.what = sentence.text;
  problem.options_of_what = sentence.options;
  problem.begin_with("a.csv: ");
  problem.name_options(in_capitals);
  EXPECT_EQ(problem.what, "a.csv: is not for --sampling-rate");
}

}  // namespace
}  // namespace zwidth
