#pragma once

#include <optional>
#include <string_view>

namespace zwidth::internal {

/// Whether a word is a unit of measurement as tables have it, in brackets or not: "s", "[mm]", "(N m)".
[[nodiscard]] bool is_unit(std::string_view word);

/// Seconds per unit of time: "ms" is 1e-3; nothing where the word is no unit of time.
[[nodiscard]] std::optional<double> seconds_per(std::string_view unit);

/// The unit that a column's name ends with after "_", "." or a space: "mm" of "x_mm"; empty where there is none for sure.
[[nodiscard]] std::string_view unit_at_end(std::string_view name);

/// Base units per unit with a prefix: "mm" is 1e-3 (m), "kN" 1e3, "deg" pi/180; nothing where the unit is a base unit
/// or not known.
[[nodiscard]] std::optional<double> base_units_per(std::string_view unit);

}  // namespace zwidth::internal
