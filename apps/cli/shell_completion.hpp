#pragma once

#include <string>
#include <vector>

#include "cli/command_description.hpp"

namespace zwidth::cli {

/// Scripts that complete the program's command lines: to be sourced, or installed where the shell looks for them.
/// `commands` is what describe() answers.
[[nodiscard]] std::string bash_completion(const std::vector<CommandDescription>& commands);
[[nodiscard]] std::string zsh_completion(const std::vector<CommandDescription>& commands);
[[nodiscard]] std::string fish_completion(const std::vector<CommandDescription>& commands);

}  // namespace zwidth::cli
