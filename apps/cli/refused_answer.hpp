#pragma once

#include <initializer_list>
#include <string>

#include "cli/outputs.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::cli {

/// Prints an answer that is refused: its document, or without one (empty) in words whose it is and why. "Refused" is an
/// answer, exit status 0, of every command; what fails is a file of `files` (empty ones were not asked for), which
/// cannot be written without a number.
/// Throws WorkFailed where there is such a file.
void print_refused(const Outputs& outputs, const Trust& trust, const std::string& device_name,
                   const std::string& document, std::initializer_list<std::string> files);

}  // namespace zwidth::cli
