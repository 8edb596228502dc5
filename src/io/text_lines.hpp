#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "io/input_file.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

/// One line of a text and its number from 1.
struct TextLine {
  std::size_t number = 0;
  std::string_view text;  ///< without the line's end
};

/// Lines of a file of any size, of which one block at a time is in memory.
class TextLines {
 public:
  /// Reads the first block of the file.
  [[nodiscard]] static tl::expected<TextLines, InputError> start(InputFile file);

  /// What has been read and not yet handed out: before the first line, the file's first MiB.
  [[nodiscard]] std::string_view buffered() const { return {buffer_.data() + begin_, end_ - begin_}; }
  /// Whether buffered() goes to the file's end.
  [[nodiscard]] bool buffered_to_the_end() const { return ended_; }

  /// Passes over the next bytes (a byte-order mark).
  void skip(std::size_t bytes) { begin_ += bytes; }

  /// The next line, valid until the one after; nothing at the end. Refused: a line longer than 4 MiB.
  [[nodiscard]] tl::expected<std::optional<TextLine>, InputError> next(const Progress& progress);

  /// Whether the last line was the file's last and had no line end: it may have been cut off.
  [[nodiscard]] bool last_line_is_open() const { return open_line_; }

  [[nodiscard]] const InputFile& file() const { return file_; }

 private:
  explicit TextLines(InputFile file) : file_(std::move(file)) {}
  [[nodiscard]] tl::expected<void, InputError> refill();

  InputFile file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t line_ = 0;
  std::uintmax_t bytes_read_ = 0;
  bool ended_ = false;
  bool open_line_ = false;
};

}  // namespace zwidth::internal
