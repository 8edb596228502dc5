#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace zwidth::internal {

/// Cuts lines of a text table into cells.
class CellSplitter {
 public:
  /// `delimiter` ' ' stands for any run of blanks and tabs.
  explicit CellSplitter(char delimiter) : delimiter_(delimiter) {}

  /// The cells of a line, each a part of it, without quotes and the blanks around them; valid until the next line.
  [[nodiscard]] std::span<const std::string_view> split(std::string_view line);

 private:
  void add_cell_of_blanks(std::string_view& rest);
  void add_unquoted_cells(std::string_view line);
  void add_cell(std::string_view& rest);

  char delimiter_;
  std::vector<std::string_view> cells_;
};

}  // namespace zwidth::internal
