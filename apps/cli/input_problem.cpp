#include "cli/input_problem.hpp"

#include <array>
#include <string_view>
#include <utility>

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

std::string input_problem(InputError error) {
  if (error.source == override_source) error.source = "--set";
  for (const auto& [member, option] : options_of_members) {
    for (auto at = error.allowed.find(member); at != std::string::npos; at = error.allowed.find(member, at)) {
      error.allowed.replace(at, member.size(), option);
    }
  }
  return error.str();
}

}  // namespace zwidth::cli
