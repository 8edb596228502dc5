#pragma once

#include <string>
#include <vector>

#include "cli/command_description.hpp"

namespace zwidth::cli {

/// The page of one of the commands, or of the program (the first), in man(7)'s macros. `commands` is what describe()
/// answers.
[[nodiscard]] std::string manual_page(const std::vector<CommandDescription>& commands,
                                      const CommandDescription& command);

}  // namespace zwidth::cli
