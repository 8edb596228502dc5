#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace zwidth::report {

/// Runs gnuplot on `script` and returns what it writes to its standard output (the picture, as `set output` is unset).
///
/// Throws OutputFailed when gnuplot is not installed (with the remedy), refuses the script, or does not finish within
/// `time_limit`, in which case it is killed.
[[nodiscard]] std::string run_gnuplot(std::string_view script,
                                      std::chrono::milliseconds time_limit = std::chrono::seconds(60));

/// `text` as a gnuplot string constant. Single quotes: gnuplot then interprets neither escapes nor backquotes.
/// Control characters become spaces.
[[nodiscard]] std::string gnuplot_string(std::string_view text);

/// `text` as it is drawn: the string and gnuplot's mode of it. Symbols of the texts ("K_CR", "t_d") get their subscripts;
/// all else, such as an underscore of a name, stands as it is.
[[nodiscard]] std::string gnuplot_text(std::string_view text);

}  // namespace zwidth::report
