#include "cli/option_refusal.hpp"

namespace zwidth::cli {

void refuse(const OptionProblem& problem, OptionsByMember options, std::string_view file) {
  InputProblem told =
      input_problem_of(problem, {.file = std::string(file), .option = std::string(option_of(options, problem.member))});
  if (told.place.option.empty() && !problem.member.empty()) told.what = problem.member + " " + told.what;
  throw BadInput(std::move(told));
}

}  // namespace zwidth::cli
