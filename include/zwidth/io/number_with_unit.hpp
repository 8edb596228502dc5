#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "zwidth/model/device.hpp"
#include "zwidth/model/device_key.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth {

/// Why a text is not a number with a unit of what is measured.
struct UnitProblem {
  std::string what;                                      ///< "\"kg\" is no unit of stiffness"
  std::string allowed;                                   ///< "must be in N/m, such as \"5 kN/m\", or a number in N/m"
  std::optional<std::string> suggestion = std::nullopt;  ///< what was probably meant: "22 g cm2" of "22 gcm2"
  std::optional<Problem> problem = {};                   ///< what these are the words of, where it is data
};

/// The number in SI units (angles in radians, Measure::frequency_hz in Hz) that a text such as "22 kg cm^2" states.
///
/// The unit is a product of powers with a plain scale factor: "N m/deg", "mN.m", "1 turn/4096".
/// A turn, a count of 1 and forces of a weight are known beside the SI's units; of a rotary motion, the radian may be
/// left out ("N m s"). A decimal prefix loses nothing: "400 us" is the double nearest to 4e-4.
///
/// Requires a finite number and a unit of that measure: fails for any other text, whatever its bytes.
[[nodiscard]] tl::expected<double, UnitProblem> number_with_unit(std::string_view text, Measure measure, Motion motion);

/// A number with a comma for its decimal mark, and what is behind it, with a point: "0.5 kg" of "0,5 kg"; nothing where
/// the comma may stand between thousands, and without one.
[[nodiscard]] std::optional<std::string> with_decimal_point(std::string_view text);

/// The SI unit of a plain number: "N m/rad"; empty for a ratio.
[[nodiscard]] std::string_view si_unit(Measure measure, Motion motion);

/// What a text must be instead: "must be a number of N m/rad, or a text with its unit such as \"0.4 N m/deg\"".
[[nodiscard]] std::string allowed_numbers(Measure measure, Motion motion);

}  // namespace zwidth
