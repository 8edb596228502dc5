#pragma once

#include <string>

#include "zwidth/io/input_error.hpp"

namespace zwidth::cli {

/// error.str() in terms of the command line: members of options are options, and an override is --set.
[[nodiscard]] std::string input_problem(InputError error);

}  // namespace zwidth::cli
