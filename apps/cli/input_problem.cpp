#include "cli/input_problem.hpp"

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "cli/subcommand.hpp"

namespace zwidth::cli {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 7> options_of_members = {
    {{"`rate`", "--rate"},
     {"`time_column`", "--time"},
     {"`time_scale`", "--time-scale"},
     {"`timer_bits`", "--timer-bits"},
     {"`skip_rows`", "--skip-rows"},
     {"`lowest`", "--lowest-hz"},
     {"`highest`", "--highest-hz"}}};

}  // namespace

std::vector<InputProblem> problems_in(const InputError& error) {
  std::vector<InputProblem> problems = error.problems();
  for (InputProblem& each : problems) {
    if (each.place.file == override_source) {
      each.place.file.clear();
      each.place.option = "--set";
    }
    for (const auto& [member, option] : options_of_members) {
      for (auto at = each.allowed.find(member); at != std::string::npos; at = each.allowed.find(member, at)) {
        each.allowed.replace(at, member.size(), option);
      }
    }
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
