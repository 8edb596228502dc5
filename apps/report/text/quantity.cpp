#include "report/text/quantity.hpp"

#include <fmt/format.h>

namespace zwidth::report {

std::string crossover_frequency_text(double frequency) {
  if (frequency == 0.0) return "0 Hz (a real pole at rest)";
  return fmt::format("{} ({} rad/s)", quantity(hertz(frequency), "Hz"), number(frequency));
}

}  // namespace zwidth::report
