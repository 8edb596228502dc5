#include "cli/option_refusal.hpp"

#include "cli/subcommand.hpp"

namespace zwidth::cli {

void refuse(const OptionProblem& problem, std::span<const std::pair<std::string_view, std::string_view>> options,
            std::string_view file) {
  InputProblem told{{}, problem.what, problem.allowed, {}};
  told.problem = problem.problem;
  told.place.file = file;
  for (const auto& [member, option] : options) {
    if (member == problem.member) told.place.option = option;
  }
  if (told.place.option.empty() && !problem.member.empty()) told.what = problem.member + " " + told.what;
  throw BadInput(std::move(told));
}

}  // namespace zwidth::cli
