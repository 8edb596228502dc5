#pragma once

#include <string_view>

namespace zwidth::cli {

/// Call once, before any file is opened: occupies standard descriptors that were closed, so that no output file lands
/// on one of them, and turns SIGPIPE into an error of the write.
void prepare_standard_output() noexcept;

/// Writes all of `text` to standard output, or throws WorkFailed (full disk, closed descriptor).
/// A reader that has closed its end of the pipe ends the program quietly, as done.
void write_standard_output(std::string_view text);

/// Writes `text` to standard error; a failure there is ignored, since there is nowhere left to report it.
void write_standard_error(std::string_view text) noexcept;

}  // namespace zwidth::cli
