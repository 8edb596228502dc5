#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace zwidth::report {

/// A result that could not be written or drawn; what() is one line that names the file or program and the remedy.
struct OutputFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Takes the next piece of a text.
using Sink = std::function<void(std::string_view)>;

/// Files that appear together, whole or not at all: each is written to a file without a name on the disk of its place and
/// flushed; commit() names them and renames them over what was there. So an interrupted program leaves nothing behind.
/// Where the file system has no such files, each has a name beside its place from the beginning.
///
/// A symbolic link is followed. What is not a regular file (/dev/stdout, a FIFO) is written straight through.
/// What fails (missing or unwritable directory, full disk, a directory) throws OutputFailed; then, and without
/// commit(), what was there before stays.
class OutputFiles {
 public:
  OutputFiles() = default;
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;
  ~OutputFiles();

  void write(const std::string& path, std::string_view contents);
  /// A text made piece by piece, which need not fit into memory: `produce` is called once, with where to put its
  /// pieces. What it throws passes through.
  void write(const std::string& path, const std::function<void(const Sink&)>& produce);
  void commit();

  /// What write() would fail for now, before there is anything to write: nothing is left behind. A full disk is found
  /// only by writing. What is not a regular file is not opened.
  static void require_writable(const std::string& path);

 private:
  struct Pending {
    std::string path;  ///< as given, for messages
    std::string temporary;
    std::string target;
    int unnamed = -1;  ///< open, while the temporary has no name; else -1
  };
  std::vector<Pending> pending_;
};

/// One file by itself.
void write_whole(const std::string& path, std::string_view contents);
void write_whole(const std::string& path, const std::function<void(const Sink&)>& produce);

/// Creates the directory, and its parents, where missing; throws OutputFailed.
void make_directory(const std::string& path);

}  // namespace zwidth::report
