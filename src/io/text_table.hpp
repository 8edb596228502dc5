#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "io/csv_dialect.hpp"
#include "io/number_cell.hpp"
#include "io/text_lines.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth::internal {

/// One row of a text table.
struct TextRow {
  TextLine line;
  std::span<const std::string_view> cells;  ///< parts of the line; as many as the table has columns
};

/// A table of numbers in a text file of any size, read once from its first row to its last.
class TextTable {
 public:
  /// Passes over the lines that the options say, and finds the layout from the first lines. Refused: an empty file, UTF-16, binary data, no row of numbers.
  [[nodiscard]] static tl::expected<TextTable, InputError> open(TextLines lines, const RecordingOptions& options);
  [[nodiscard]] static tl::expected<TextTable, InputError> open(const std::string& path,
                                                                const RecordingOptions& options);

  [[nodiscard]] const std::string& source() const { return lines_.file().source(); }
  [[nodiscard]] std::size_t columns() const { return dialect_.columns; }
  [[nodiscard]] bool has_header() const { return !dialect_.names.empty(); }
  /// The header's names; without a header the columns' numbers from 1.
  [[nodiscard]] std::vector<std::string> names() const;
  /// How many rows the file is likely to have, from its size and its first lines; 0 where its size is not known.
  [[nodiscard]] std::size_t likely_rows() const;

  using RowVisitor = std::function<tl::expected<void, InputError>(const TextRow& row)>;
  /// Visits every row. Refused with its line: a row with too few or too many cells (a delimiter at the end is allowed).
  [[nodiscard]] tl::expected<void, InputError> each_row(const RowVisitor& visit, const Progress& progress = {});

  /// The number in a cell. The first cell that shows a decimal mark fixes it, where the layout did not.
  [[nodiscard]] NumberCell number(std::string_view cell);
  [[nodiscard]] std::optional<std::complex<double>> complex_number(std::string_view cell) const;
  /// Where a cell of a row (a column from 0) stands.
  [[nodiscard]] InputPlace place(const TextRow& row, std::size_t column) const;
  /// The refusal of such a cell in which a number must stand. `as`: "time", which has a remedy of its own, or nothing.
  [[nodiscard]] InputError no_number(const TextRow& row, std::size_t column, const std::string& as = {}) const;

  /// What was detected and, after each_row(), what was passed over.
  [[nodiscard]] const std::vector<Remark>& remarks() const { return dialect_.remarks; }

 private:
  TextTable(TextLines lines, CsvDialect dialect, std::string comment, double line_length);
  [[nodiscard]] InputError wrong_cells(const TextLine& line, std::size_t cells, std::size_t rows_above) const;

  TextLines lines_;
  CsvDialect dialect_;
  std::string comment_;
  double line_length_;  ///< mean, bytes
};

inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// The refusal of a text of which these are the first bytes; nothing where it may be a table.
[[nodiscard]] std::optional<InputError> refused_as_text(std::string_view first_bytes, const std::string& source);

}  // namespace zwidth::internal
