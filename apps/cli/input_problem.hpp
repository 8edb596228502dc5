#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "zwidth/io/input_error.hpp"
#include "zwidth/option_text.hpp"

namespace zwidth::cli {

/// All of the error in terms of the command line: members of options are options, and an override is --set.
[[nodiscard]] std::vector<InputProblem> problems_in(const InputError& error);

/// Throws BadInput with them. `option`: the one that names what was read, where it is told.
[[noreturn]] void refuse_input(const InputError& error, std::string_view option = {});
/// The same of what a command asks of a key of a file.
[[noreturn]] void refuse_key(const std::string& file, const std::string& key, std::string what, OptionText allowed,
                             std::string_view option = {});

}  // namespace zwidth::cli
