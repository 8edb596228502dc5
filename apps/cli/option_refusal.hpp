#pragma once

#include <string_view>

#include "cli/subcommand.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth::cli {

/// Throws BadInput: "--duration: is nan s; allowed", or with the file's name "--duration: FILE: is nan s; ...". `options`: the option that sets each member of an options struct;
/// a problem without a member, or of one that no option sets, is told without an option.
[[noreturn]] void refuse(const OptionProblem& problem, OptionsByMember options, std::string_view file = {});

}  // namespace zwidth::cli
