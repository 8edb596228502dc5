#pragma once

#include <optional>
#include <string_view>

#include "zwidth/signal/recording.hpp"

namespace zwidth::internal {

/// Whether a word is a unit of measurement as tables have it, in brackets or not: "s", "[mm]", "(N m)".
[[nodiscard]] bool is_unit(std::string_view word);

/// Seconds per unit of time: "ms" is 1e-3; nothing where the word is no unit of time.
[[nodiscard]] std::optional<double> seconds_per(std::string_view unit);

/// What a column's name says of its unit.
struct ColumnUnit {
  std::string_view text = {};  ///< as it is written; empty: nothing for sure
  StatedQuantity quantity = StatedQuantity::nothing;
  std::string_view base = {};  ///< the base unit: "N", "N m", "rad", "m/s"; empty where it is not known
  double factor = 1.0;         ///< base units (N, N m, m, rad, A, V and their rates) per unit; 1 where it is not known
};

/// Of a unit in brackets or parentheses, or at the end after one of "_ .:,/": "x [mm]", "F (in mN)", "angle_deg", "force/mN".
/// What stands in brackets is a unit, if a strange one; at the end only what could be no part of a name ("force_in").
[[nodiscard]] ColumnUnit unit_of_column(std::string_view name);

}  // namespace zwidth::internal
