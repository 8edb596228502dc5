#include "cli/input_problem.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "cli/subcommand.hpp"

namespace zwidth::cli {
namespace {

constexpr std::pair<std::string_view, std::string_view> options_of_reading[] = {{"rate", "--rate"},
                                                                                {"time_column", "--time"},
                                                                                {"time_scale", "--time-scale"},
                                                                                {"timer_bits", "--timer-bits"},
                                                                                {"skip_rows", "--skip-rows"},
                                                                                {"lowest", "--lowest-hz"},
                                                                                {"highest", "--highest-hz"}};

std::optional<std::string> name_of_option(std::string_view member) {
  const std::string_view option = option_of(options_of_reading, member);
  return option.empty() ? std::nullopt : std::optional(std::string(option));
}

}  // namespace

std::vector<InputProblem> problems_in(const InputError& error) {
  std::vector<InputProblem> problems = error.problems();
  for (InputProblem& each : problems) {
    if (each.place.file == override_source) {
      each.place.file.clear();
      each.place.option = "--set";
    }
    if (const auto option = name_of_option(each.place.option)) each.place.option = *option;
    each.name_options(name_of_option);
  }
  return problems;
}

void refuse_input(const InputError& error, std::string_view option) {
  std::vector<InputProblem> problems = problems_in(error);
  for (InputProblem& each : problems) {
    if (!option.empty()) each.place.option = option;
  }
  throw BadInput(std::move(problems));
}

void refuse_key(const std::string& file, const std::string& key, std::string what, OptionText allowed,
                std::string_view option) {
  InputProblem problem{{.file = file, .key = key}, std::move(what), {}, {}};
  problem.allow(std::move(allowed));
  refuse_input(InputError(std::move(problem)), option);
}

}  // namespace zwidth::cli
