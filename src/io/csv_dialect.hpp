#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "io/text_lines.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth::internal {

/// How a text table is written.
struct CsvDialect {
  char delimiter = ',';              ///< ' ': any run of blanks
  std::optional<char> decimal_mark;  ///< absent while no number has shown one
  std::size_t columns = 0;
  std::vector<std::string> names;  ///< of the header, with their units; empty where there is none
  std::size_t first_row = 1;       ///< line of the first row: what stands before it is header
  std::vector<Remark> remarks;     ///< what was detected
};

/// Whether a line holds nothing but blanks, or a comment (its first character that is no blank is one of `comment`).
[[nodiscard]] bool is_empty_line(std::string_view line);
[[nodiscard]] bool is_comment_line(std::string_view line, std::string_view comment);

/// Finds delimiter, decimal mark and header of a table from its first lines (comments and empty lines among them), as
/// far as `options` do not give them: what reads the most cells as numbers, with a header of as many cells.
/// Refused: options that contradict each other, and lines that hold no row of numbers.
[[nodiscard]] tl::expected<CsvDialect, InputError> detect_csv_dialect(std::span<const TextLine> head,
                                                                      const RecordingOptions& options,
                                                                      const std::string& source);

}  // namespace zwidth::internal
