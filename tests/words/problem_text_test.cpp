// The words of options that cannot be used, from codes and numbers.

#include "zwidth/words/problem_text.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "require_argument.hpp"
#include "words/problem_phrase.hpp"
#include "zwidth/error.hpp"
#include "zwidth/input_problem.hpp"

namespace zwidth {
namespace {

using internal::counted;

/// "what; allowed"
std::string line(Problem problem) {
  const OptionProblem told = option_problem("member", std::move(problem));
  EXPECT_EQ(told.member, "member");
  return told.what + "; " + told.allowed;
}

TEST(ProblemText, EveryCodeHasWordsOfItsOwnName) {
  std::set<std::string_view> names;
  std::size_t count = 0;
  for (const std::span<const internal::ProblemPhrase> list : internal::problem_phrases()) {
    for (const internal::ProblemPhrase& each : list) {
      EXPECT_EQ(name_of(each.code), each.name);
      names.insert(each.name);
      ++count;
    }
  }
  EXPECT_EQ(names.size(), count) << "a name stands twice";
  EXPECT_EQ(names.size(), static_cast<std::size_t>(ProblemCode::poles_not_told_apart) + 1) << "the last code";
}

TEST(ProblemText, GivesANumberWithAllItsDigitsAndItsUnit) {
  EXPECT_EQ(
      line(
          {.code = ProblemCode::not_finite_and_positive, .evidence = {{"value", -0.1}}, .subjects = {{"in", "rad/s"}}}),
      "is -0.1; must be a number of rad/s > 0");
  EXPECT_EQ(line({.code = ProblemCode::not_finite_and_positive,
                  .evidence = {{"value", 0.0}},
                  .subjects = {{"what", "force"}}}),
            "is 0; must be a force > 0");
  EXPECT_EQ(line({.code = ProblemCode::not_finite_and_positive,
                  .evidence = {{"value", std::numeric_limits<double>::infinity()}, {"times", 1.0}}}),
            "is inf times; must be finite and > 0");
  EXPECT_EQ(
      line({.code = ProblemCode::negative, .evidence = {{"value", -1e-5}}, .subjects = {{"in", "s"}, {"unit", "s"}}}),
      "is -1e-05 s; must be a number of s >= 0");
  EXPECT_EQ(line({.code = ProblemCode::duration_out_of_range,
                  .evidence = {{"value", 0.0}, {"least", 1e-3}, {"most", 2e4}, {"samples", 2e7}}}),
            "is 0 s; 0.001 s to 20000 s, 1 to 20000000 sampling periods");
}

TEST(ProblemText, NamesAMeasureInTheUnitsOfBothMotions) {
  const auto above_zero = [](const char* measure) {
    return line({.code = ProblemCode::not_above,
                 .evidence = {{"value", 0.0}, {"bound", 0.0}},
                 .subjects = {{"measure", measure}}});
  };
  EXPECT_EQ(above_zero("force"), "is 0; a force in N or N m above 0");
  EXPECT_EQ(above_zero("distance"), "is 0; a distance in m or rad above 0");
  EXPECT_EQ(above_zero("speed"), "is 0; a speed in m/s or rad/s above 0");
  EXPECT_EQ(above_zero("time"), "is 0; a time in s above 0");
  EXPECT_EQ(above_zero("stiffness"), "is 0; a stiffness in N/m or N m/rad above 0");
  EXPECT_THROW(above_zero("mood"), Error);
}

TEST(ProblemText, HasVariantsOfCounts) {
  EXPECT_EQ(line({.code = ProblemCode::count_out_of_range_or_zero,
                  .evidence = {counted("value", 5), counted("least", 368), counted("most", 1U << 20U),
                               counted("samples", 1000)}}),
            "is 5; must be 0, or 368 to 1048576, and no more than the 1000 samples");
  EXPECT_EQ(line({.code = ProblemCode::count_out_of_range,
                  .evidence = {counted("value", 0), counted("least", 1), counted("most", 200), {"several", 1.0}}}),
            "are 0; must be 1 to 200");
  EXPECT_EQ(line({.code = ProblemCode::too_few,
                  .evidence = {counted("value", 5), counted("least", 64)},
                  .subjects = {{"unit", "samples"}}}),
            "is 5 samples; at least 64");
}

TEST(ProblemText, HasVariantsOfWholeSentences) {
  EXPECT_EQ(line({.code = ProblemCode::not_finite}), "is not finite; must be finite");
  EXPECT_EQ(line({.code = ProblemCode::not_finite, .evidence = {{"values", 1.0}}}),
            "are not all finite; must be finite");
  EXPECT_EQ(line({.code = ProblemCode::not_finite,
                  .evidence = {{"value", std::numeric_limits<double>::infinity()}, {"entry", 1.0}}}),
            "has inf; must be finite");
  EXPECT_EQ(line({.code = ProblemCode::of_the_device,
                  .subjects = {{"key", "operator.mass"}, {"what", "is -1"}, {"allowed", "must be > 0"}}}),
            "operator.mass is -1; must be > 0");
  EXPECT_EQ(line({.code = ProblemCode::of_the_device,
                  .evidence = {{"colon", 1.0}},
                  .subjects = {{"key", "operator.mass"}, {"what", "is -1"}, {"allowed", "must be > 0"}}}),
            "operator.mass: is -1; must be > 0");
  Problem slow{
      .code = ProblemCode::serial_line_too_slow,
      .evidence = {
          {"bytes", 20.0}, {"baud", 115200.0}, {"carried_hz", 460.0}, {"wanted_hz", 1000.0}, {"period", 0.0022}}};
  EXPECT_EQ(line(slow),
            "20 bytes per cycle at 115200 Bd leave 460 Hz at most, the loop runs at 1000 Hz; loop.sampling_period to "
            "0.0022 s or more");
  slow.evidence.push_back({"sufficient_baud", 460800.0});
  EXPECT_EQ(line(slow),
            "20 bytes per cycle at 115200 Bd leave 460 Hz at most, the loop runs at 1000 Hz; set the drive and "
            "driver.baud to 460800 or more, or loop.sampling_period to 0.0022 s or more");
}

TEST(ProblemText, HasVariantsOfDevices) {
  const auto coefficients = [](std::vector<Evidence> evidence) {
    return line({.code = ProblemCode::number_of_coefficients, .evidence = std::move(evidence)});
  };
  EXPECT_EQ(coefficients({{"count", 0.0}, {"most", 101.0}}), "is empty; must be one or more coefficients");
  EXPECT_EQ(coefficients({{"count", 102.0}, {"most", 101.0}}),
            "has 102 coefficients; must be at most 101 coefficients");
  EXPECT_EQ(coefficients({{"count", 4.0}, {"least", 2.0}, {"most", 3.0}}),
            "has 4 coefficients; must have 2 to 3, by falling powers");
  EXPECT_EQ(coefficients({{"count", 4.0}, {"denominator", 3.0}}),
            "has 4 coefficients; must have at least 1 and no more than the denominator");
  const auto beside = [](const char* part) {
    return line({.code = ProblemCode::beside_transfer_function, .subjects = {{"part", part}}});
  };
  EXPECT_EQ(beside("loop"), "names a body beside [transfer_function]; a transfer function has no bodies: leave it out");
  EXPECT_EQ(beside("operator"), "stands beside [transfer_function]; an operator needs bodies: leave it out");
  EXPECT_EQ(line({.code = ProblemCode::not_between,
                  .evidence = {{"value", 128.0}, {"least", 0.0}, {"most", 127.0}, {"whole", 1.0}}}),
            "is 128; must be a whole number from 0 to 127");
  EXPECT_EQ(line({.code = ProblemCode::no_finite_number, .evidence = {{"value", -1.0}, {"from_zero", 1.0}}}),
            "is -1; must be a finite number >= 0");
  EXPECT_EQ(line({.code = ProblemCode::no_finite_number, .evidence = {{"value", 0.0}}}),
            "is 0; must be a finite number > 0");
}

TEST(ProblemText, NamesTheArgumentOfACall) {
  const auto refused = [](const auto& call) {
    try {
      call();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused([] {
              internal::require_positive({"sampling period", -1.0, "s"});
            }),
            "sampling period is -1 s; must be finite and > 0");
  EXPECT_EQ(refused([] { internal::require_not_negative({"floor", -1.0}); }), "floor is -1; must be >= 0");
  EXPECT_EQ(refused([] {
              internal::require_fraction({"coverage", 1.0});
            }),
            "coverage is 1; must be above 0 and below 1");
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_NE(refused([=] { internal::require_positive({"period", infinite}); }), "");
  EXPECT_NE(refused([=] { internal::require_not_negative({"delay", infinite}); }), "");
  EXPECT_EQ(refused([] { internal::require_not_negative({"delay", 0.0}); }), "");
}

TEST(ProblemText, NamesOptionsWhereThePhraseDoesAndNotWhereAUserDoes) {
  InputProblem told = input_problem({.file = "study.toml", .line = 3, .column = 1},
                                    {.code = ProblemCode::reaches_no_device,
                                     .evidence = {{"value", -1.0}},
                                     .subjects = {{"name", "`most`"},
                                                  {"key", "loop.delay"},
                                                  {"what", "is -1"},
                                                  {"allowed", "must be >= 0"},
                                                  {"end", "least"}}},
                                    "0");
  EXPECT_EQ(told.place.line, 3U);
  ASSERT_TRUE(told.problem);
  EXPECT_EQ(told.problem->code, ProblemCode::reaches_no_device);
  EXPECT_EQ(told.suggestion, "0");
  EXPECT_EQ(told.what, "`most`: reaches -1, which is no device: loop.delay is -1");
  EXPECT_TRUE(told.options_of_what.empty());
  ASSERT_EQ(told.options_of_allowed.size(), 1U);
  EXPECT_EQ(told.options_of_allowed[0].name, "least");
}

}  // namespace
}  // namespace zwidth
