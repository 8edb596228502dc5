#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

#include "io/cell_splitter.hpp"
#include "io/number_cell.hpp"
#include "io/text_lines.hpp"
#include "zwidth/io/input_error.hpp"

namespace zwidth::internal {

/// A line of an export and its cells.
struct ExportLine {
  TextLine line;
  std::span<const std::string_view> cells;  ///< valid until the next line
  bool may_be_cut_off = false;              ///< the file's last and without an end

  [[nodiscard]] bool is_empty() const;  ///< no cell has anything in it
  /// The cell, or nothing where the line ends before.
  [[nodiscard]] std::string_view cell(std::size_t index) const {
    return index < cells.size() ? cells[index] : std::string_view();
  }
};

/// What the line begins with, in quotes.
[[nodiscard]] std::string beginning_of(const ExportLine& line);

/// The lines of the export of a measuring program, cut into cells.
class ExportLines {
 public:
  /// `decimal_mark`: where the user gives one; between commas it is a point.
  ExportLines(TextLines lines, char delimiter, std::optional<char> decimal_mark, const Progress& progress)
      : lines_(std::move(lines)), splitter_(delimiter), decimal_mark_(decimal_mark), progress_(progress) {
    if (!decimal_mark_ && delimiter == ',') decimal_mark_ = '.';
  }

  /// The next line; nothing at the end. Refused: a line longer than 4 MiB.
  [[nodiscard]] tl::expected<std::optional<ExportLine>, InputError> next();

  /// Calls `take` with every line that is left, until it refuses one.
  template <typename Take>
  tl::expected<void, InputError> for_each(const Take& take) {
    while (true) {
      auto line = next();
      if (!line) return tl::unexpected(std::move(line.error()));
      if (!*line) return {};
      if (auto taken = take(**line); !taken) return taken;
    }
  }

  /// The number in a cell. The first cell that shows a decimal mark fixes it, where it was not given.
  [[nodiscard]] NumberCell number(std::string_view cell);
  [[nodiscard]] std::optional<char> decimal_mark() const { return decimal_mark_; }
  void set_decimal_mark(char mark) { decimal_mark_ = mark; }

  [[nodiscard]] const std::string& source() const { return lines_.file().source(); }
  [[nodiscard]] InputError refused(const ExportLine& line, Problem problem) const;
  /// The refusal of a line of another number of cells than `expected` of `what` has: "sample", "section".
  [[nodiscard]] InputError wrong_cells(const ExportLine& line, std::size_t cells, std::size_t expected,
                                       std::string what) const;
  /// The refusal of a cell in which a number must stand.
  [[nodiscard]] InputError no_number(const ExportLine& line, std::size_t cell, const std::string& column) const;

 private:
  TextLines lines_;
  CellSplitter splitter_;
  std::optional<char> decimal_mark_;
  const Progress& progress_;
};

}  // namespace zwidth::internal
