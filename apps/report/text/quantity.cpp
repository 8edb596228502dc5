#include "report/text/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace zwidth::report {

std::string crossover_frequency_text(double frequency) {
  if (frequency == 0.0) return "0 Hz (a real pole at rest)";
  return fmt::format("{} ({} rad/s)", quantity(hertz(frequency), "Hz"), number(frequency));
}

std::string limit_value_text(double limit, std::string_view unit) {
  if (std::isnan(limit)) return "refused";
  if (limit == 0.0) return "none";
  return std::isfinite(limit) ? quantity(limit, unit) : "unbounded";
}

std::string short_name(const Oscillator& oscillator) {
  return oscillator.kind == Oscillator::Kind::rigid_body ? "rigid body" : fmt::format("mode {}", oscillator.mode);
}

std::string long_name(const Oscillator& oscillator) {
  return oscillator.kind == Oscillator::Kind::rigid_body ? "the rigid body"
                                                         : fmt::format("vibration mode {}", oscillator.mode);
}

std::string parameter_text(const std::string& key, double value, Motion motion) {
  const std::string unit = parameter_unit(key, motion);
  if (unit.empty()) return number(value);
  // Prefixes with units of one word only: no "mkg", no "mN s/m".
  return unit == "s" || unit == "Hz" || key.ends_with(".stiffness") ? quantity(value, unit)
                                                                    : fmt::format("{} {}", number(value), unit);
}

std::string share_of_all_text(double share) {
  const double rest = std::min(share, 1.0 - share);
  const int digits = rest <= 0.0 ? 2 : std::clamp(static_cast<int>(std::ceil(1.0 - std::log10(rest * 100.0))), 2, 8);
  return fmt::format("{:.{}f} %", 100.0 * share, digits);
}

std::string factor_text(double factor) {
  if (factor >= 2.0) return fmt::format("x {:.3g}", factor);
  return factor > 0.5 ? fmt::format("{:+.3g} %", 100.0 * (factor - 1.0)) : fmt::format("/ {:.3g}", 1.0 / factor);
}

}  // namespace zwidth::report
