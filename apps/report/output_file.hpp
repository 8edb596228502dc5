#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace zwidth::report {

/// A result that could not be written or drawn; what() is one line that names the file or program and the remedy.
struct OutputFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Writes `contents` to `path`, whole or not at all: a temporary beside it, flushed to disk, then renamed over it.
///
/// A symbolic link is followed. What is not a regular file (/dev/stdout, a FIFO) is written straight through.
/// Throws OutputFailed and leaves what was there before (missing or unwritable directory, full disk, a directory).
void write_whole(const std::string& path, std::string_view contents);

/// Takes the next piece of a text.
using Sink = std::function<void(std::string_view)>;

/// The same for a text made piece by piece, which need not fit into memory: `produce` is called once, with where to put
/// its pieces. What it throws passes through, and then too the old file stays.
void write_whole(const std::string& path, const std::function<void(const Sink&)>& produce);

/// Creates the directory, and its parents, where missing; throws OutputFailed.
void make_directory(const std::string& path);

}  // namespace zwidth::report
