#include "cli/option_refusal.hpp"

#include <fmt/format.h>

#include "cli/subcommand.hpp"

namespace zwidth::cli {

void refuse(const OptionProblem& problem, std::span<const std::pair<std::string_view, std::string_view>> options) {
  for (const auto& [member, option] : options) {
    if (member == problem.member) throw BadInput(fmt::format("{}: {}; {}", option, problem.what, problem.allowed));
  }
  throw BadInput(problem.member.empty() ? fmt::format("{}: {}", problem.what, problem.allowed)
                                        : fmt::format("{} {}; {}", problem.member, problem.what, problem.allowed));
}

}  // namespace zwidth::cli
