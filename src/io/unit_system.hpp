#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace zwidth::internal {

/// How many `wanted` one `unit` is, where it is a plain factor: unit_factor("N m/deg", "N m/rad") is 180/pi.
///
/// The radian is a dimension of its own here and Hz is a turn per second, so that "rad/s" and "Hz" differ by 2 pi.
/// In extended precision, so that 60 rpm are 2 pi rad/s to the last
/// digit. Both in ASCII (ascii_unit()). None where `unit` is no unit, of another dimension, or more than a factor.
[[nodiscard]] std::optional<long double> unit_factor(const std::string& unit, const std::string& wanted);

/// Whether the text is a unit of any dimension.
[[nodiscard]] bool is_unit(const std::string& unit);

/// The unit in ASCII letters ("µ" as "u", "²" as "^2", "·" as "."), or none where it has what no unit has.
[[nodiscard]] std::optional<std::string> ascii_unit(std::string_view text);

}  // namespace zwidth::internal
