#include "report/text/quantity.hpp"

#include <fmt/format.h>

namespace zwidth::report {

std::string crossover_frequency_text(double frequency) {
  if (frequency == 0.0) return "0 Hz (a real pole at rest)";
  return fmt::format("{} ({} rad/s)", quantity(hertz(frequency), "Hz"), number(frequency));
}

std::string parameter_text(const std::string& key, double value, Motion motion) {
  const std::string unit = parameter_unit(key, motion);
  if (unit.empty()) return number(value);
  // Prefixes with units of one word only: no "mkg", no "mN s/m".
  return unit == "s" || unit == "Hz" || key.ends_with(".stiffness") ? quantity(value, unit)
                                                                    : fmt::format("{} {}", number(value), unit);
}

}  // namespace zwidth::report
