#include "zwidth/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace zwidth {

Units units_of(Motion motion) {
  if (motion == Motion::rotary) return {"N m/rad", "N m s/rad", "kg m²", "N m", "rad"};
  return {"N/m", "N s/m", "kg", "N", "m"};
}

std::string number(double value) {
  const double magnitude = std::abs(value);
  if (magnitude != 0.0 && (magnitude < 1e-3 || magnitude >= 1e5)) return fmt::format("{:.4g}", value);
  if (magnitude >= 1e3) return fmt::format("{:.0f}", value);
  return fmt::format("{:.4g}", value);
}

std::string quantity(double value, std::string_view unit) {
  static constexpr std::array<std::string_view, 7> prefixes = {"n", "µ", "m", "", "k", "M", "G"};
  static constexpr int no_prefix = 3;
  // Beyond all prefixes, and where rounding could leave the range of a double.
  const bool is_extreme = std::abs(value) < 1e-300 || std::abs(value) > 1e300;
  if (is_extreme || !std::isfinite(value)) return fmt::format("{:.4g} {}", value, unit);
  // Rounded to four digits first, so that 999.96 becomes 1 k and not 1000.
  const double rounded = std::stod(fmt::format("{:.3e}", value));
  if (std::abs(rounded) < 1e-9) return fmt::format("{:.4g} {}", rounded, unit);
  const int thousands = static_cast<int>(std::floor(std::log10(std::abs(rounded)) / 3.0 + 1e-9));
  const int prefix = std::clamp(thousands + no_prefix, 0, static_cast<int>(prefixes.size()) - 1);
  const double scaled = rounded / std::pow(1000.0, prefix - no_prefix);
  return fmt::format("{} {}{}", number(scaled), prefixes[static_cast<std::size_t>(prefix)], unit);
}

double decibels(double value) { return 20.0 * std::log10(value); }

double ratio_of_decibels(double value) { return std::pow(10.0, value / 20.0); }

double hertz(double frequency) { return frequency / (2.0 * std::numbers::pi); }

double radians_per_second(double cycles) { return 2.0 * std::numbers::pi * cycles; }

double degrees(double angle) { return angle * 180.0 / std::numbers::pi; }

double radians(double angle) { return angle * std::numbers::pi / 180.0; }

}  // namespace zwidth
