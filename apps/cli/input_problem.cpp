#include "cli/input_problem.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "cli/subcommand.hpp"

namespace zwidth::cli {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 7> options_of_members = {
    {{"rate", "--rate"},
     {"time_column", "--time"},
     {"time_scale", "--time-scale"},
     {"timer_bits", "--timer-bits"},
     {"skip_rows", "--skip-rows"},
     {"lowest", "--lowest-hz"},
     {"highest", "--highest-hz"}}};

std::optional<std::string> option_of(std::string_view member) {
  const auto found = std::ranges::find(options_of_members, member, [](const auto& each) { return each.first; });
  if (found == options_of_members.end()) return std::nullopt;
  return std::string(found->second);
}

}  // namespace

std::vector<InputProblem> problems_in(const InputError& error) {
  std::vector<InputProblem> problems = error.problems();
  for (InputProblem& each : problems) {
    if (each.place.file == override_source) {
      each.place.file.clear();
      each.place.option = "--set";
    }
    each.name_options(option_of);
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

}  // namespace zwidth::cli
