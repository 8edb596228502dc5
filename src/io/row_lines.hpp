#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace zwidth::internal {

/// The lines of rows, kept as the few places where something else comes between two rows.
class RowLines {
 public:
  void add(std::size_t row, std::size_t line) {
    if (line == row + offset_) return;
    offset_ = line - row;
    starts_.push_back({row, offset_});
  }
  [[nodiscard]] std::size_t line_of(std::size_t row) const {
    const auto after = std::upper_bound(starts_.begin(), starts_.end(), row,
                                        [](std::size_t value, const Start& start) { return value < start.row; });
    return row + (after == starts_.begin() ? 0 : std::prev(after)->offset);
  }

 private:
  struct Start {
    std::size_t row;
    std::size_t offset;  ///< from a row (from 0) to its line, from this row on
  };
  std::vector<Start> starts_;
  std::size_t offset_ = 0;
};

}  // namespace zwidth::internal
