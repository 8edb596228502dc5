#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace zwidth::internal {

/// Rows of a recorder that runs at one rate, told by their time stamps.
///
///     t_i = start + period slot_i + jitter
struct RowGrid {
  double period = 0.0;             ///< s, least squares; rows that are far off and pauses do not enter
  std::vector<std::size_t> slots;  ///< of each row, rising from 0; a slot between that no row has was lost

  [[nodiscard]] std::size_t lost() const { return slots.back() + 1 - slots.size(); }
};

/// Of times that rise, two at least. A row that is late, and after which the next ones come the sooner, is no gap.
[[nodiscard]] RowGrid row_grid(std::span<const double> times);

}  // namespace zwidth::internal
