#pragma once

#include <string_view>

namespace zwidth::cli {

/// Call once, before any file is opened: occupies standard descriptors that were closed, so that no output file lands
/// on one of them, turns SIGPIPE into an error of the write, and lets texts fit the terminal and the locale's letters: no
/// line is broken where standard output is no terminal and $COLUMNS not set.
void prepare_standard_output();

// Commands that a request may name print with Outputs.

/// Writes all of `text` to standard output, or throws WorkFailed (full disk, closed descriptor).
/// A reader that has closed its end of the pipe ends the program quietly, as done.
void write_standard_output(std::string_view text);

/// The same of text for people: in ASCII where the locale has no other letters.
void write_text(std::string_view text);

/// Writes `text` for people to standard error; a failure there is ignored, since there is nowhere left to report it.
void write_standard_error(std::string_view text) noexcept;

}  // namespace zwidth::cli
