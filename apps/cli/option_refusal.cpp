#include "cli/option_refusal.hpp"

#include <fmt/format.h>

#include "cli/subcommand.hpp"

namespace zwidth::cli {

void refuse(const OptionProblem& problem, std::span<const std::pair<std::string_view, std::string_view>> options,
            std::string_view file) {
  const std::string what = file.empty() ? problem.what : fmt::format("{}: {}", file, problem.what);
  for (const auto& [member, option] : options) {
    if (member == problem.member) throw BadInput(fmt::format("{}: {}; {}", option, what, problem.allowed));
  }
  throw BadInput(problem.member.empty() ? fmt::format("{}: {}", what, problem.allowed)
                                        : fmt::format("{} {}; {}", problem.member, what, problem.allowed));
}

}  // namespace zwidth::cli
