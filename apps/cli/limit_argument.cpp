#include "cli/limit_argument.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/number_text.hpp"
#include "cli/option_units.hpp"
#include "cli/subcommand.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::cli {
namespace {

constexpr const char* limit_option = "--limit";

/// A number that a limit may state.
struct StatedNumber {
  std::string_view key;
  std::string_view member;  ///< of MeasuredLimit
  Measure measure;
};

constexpr std::array<StatedNumber, 3> stated_numbers{{{"K", "stiffness", Measure::stiffness},
                                                      {"B", "damping", Measure::damping},
                                                      {"hz", "frequency_hz", Measure::frequency_hz}}};

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const std::size_t begin = std::min(text.find_first_not_of(blanks), text.size());
  return text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

bool is_key(std::string_view word, std::string_view key) {
  return std::ranges::equal(
      word, key, [](unsigned char one, unsigned char other) { return std::tolower(one) == std::tolower(other); });
}

/// The position of its key among stated_numbers.
std::size_t number_called(std::string_view word) {
  const auto found = std::ranges::find_if(stated_numbers, [&](const auto& each) { return is_key(word, each.key); });
  if (found != stated_numbers.end()) return static_cast<std::size_t>(found - stated_numbers.begin());
  const std::array<std::string, 6> known{"stiffness", "damping", "frequency", "f", "freq", "frequency_hz"};
  const std::string meant = nearest_word(word, known);
  const std::string suggestion = meant.empty() ? "" : meant == "stiffness" ? "K" : meant == "damping" ? "B" : "hz";
  Problem problem{.code = ProblemCode::no_number_of_limit, .subjects = {{"word", in_quotes(word)}}};
  if (suggestion.empty()) throw BadInput(input_problem({.option = limit_option}, std::move(problem)));
  problem.subjects.push_back({"meant", suggestion});
  throw BadInput(input_problem({.option = limit_option}, std::move(problem), suggestion));
}

/// As "3,5 Nm": the comma of a number stands where parts are told apart.
bool is_rest_of_number(std::string_view part) {
  return !part.empty() && std::isdigit(static_cast<unsigned char>(part.front())) != 0;
}

}  // namespace

MeasuredLimit measured_limit(std::string_view text, Motion motion) {
  std::array<std::optional<double>, stated_numbers.size()> values;
  for (const std::string& untrimmed : parts_of(text, ',')) {
    const std::string_view part = without_blanks(untrimmed);
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos) {
      Problem problem{.code = ProblemCode::limit_part_without_value, .subjects = {{"part", in_quotes(part)}}};
      if (is_rest_of_number(part)) problem.subjects.push_back({"decimal", "comma"});
      throw BadInput(input_problem({.option = limit_option}, std::move(problem)));
    }
    const std::size_t index = number_called(without_blanks(part.substr(0, equals)));
    const StatedNumber& stated = stated_numbers[index];
    if (values[index]) {
      throw BadInput(input_problem({.option = limit_option}, {.code = ProblemCode::given_twice,
                                                              .subjects = {{"name", std::string(stated.key)}}}));
    }
    const auto value = measured_number(without_blanks(part.substr(equals + 1)), stated.measure, motion);
    if (!value) {
      InputProblem problem = problem_of_value(limit_option, value.error());
      problem.begin_with(fmt::format("{}: ", stated.key));
      throw BadInput(std::move(problem));
    }
    values[index] = *value;
  }
  if (!values[0])
    throw BadInput(input_problem({.option = limit_option}, {.code = ProblemCode::limit_without_stiffness}));
  MeasuredLimit limit;
  limit.stiffness = *values[0];
  limit.damping = values[1].value_or(0.0);
  limit.frequency_hz = values[2];
  if (const auto problem = find_problem(limit)) {
    const auto stated = std::ranges::find(stated_numbers, problem->member, &StatedNumber::member);
    const std::string_view key = stated == stated_numbers.end() ? problem->member : stated->key;
    InputProblem told = problem_of_value(limit_option, fmt::format("{} {}", key, problem->what), problem->allowed);
    told.problem = problem->problem;
    throw BadInput(std::move(told));
  }
  return limit;
}

}  // namespace zwidth::cli
