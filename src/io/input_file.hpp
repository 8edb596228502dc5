#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "zwidth/io/input_error.hpp"

namespace zwidth::internal {

/// A file, a pipe or standard input, opened for reading.
class InputFile {
 public:
  /// Opens `path` ("-": standard input). `kind` is what the file should be, for the refusal: "device file",
  /// "recording". Refused: a directory, a device, what does not exist or may not be read.
  [[nodiscard]] static tl::expected<InputFile, InputError> open(const std::string& path, const std::string& kind);

  /// Reads up to `bytes.size()` bytes; fewer only at the end.
  [[nodiscard]] tl::expected<std::size_t, InputError> read(std::span<char> bytes);

  /// The rest, or its first `most` bytes.
  [[nodiscard]] tl::expected<std::string, InputError> read_up_to(std::size_t most);

  /// Goes on reading at a byte of a regular file.
  [[nodiscard]] tl::expected<void, InputError> seek(std::uintmax_t offset);

  [[nodiscard]] const std::string& source() const { return source_; }  ///< file name, or "standard input"
  [[nodiscard]] std::uintmax_t size() const { return size_; }          ///< bytes; 0 where it is not known (pipes)
  [[nodiscard]] bool is_regular() const { return regular_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept;
  };
  InputFile() = default;
  [[nodiscard]] InputError refusal(int error) const;

  std::string source_;
  std::string kind_;
  std::uintmax_t size_ = 0;
  bool regular_ = false;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace zwidth::internal
