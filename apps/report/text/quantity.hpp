#pragma once

#include <string>

#include "zwidth/quantity.hpp"

namespace zwidth::report {

using zwidth::decibels;
using zwidth::hertz;
using zwidth::number;
using zwidth::quantity;
using zwidth::Units;
using zwidth::units_of;

/// Where a pole leaves the unit circle, from rad/s: "6.143 Hz (38.6 rad/s)", or "0 Hz (a real pole at rest)".
[[nodiscard]] std::string crossover_frequency_text(double frequency);

}  // namespace zwidth::report
