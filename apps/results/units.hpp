#pragma once

#include <optional>
#include <string>

#include "results/json.hpp"
#include "zwidth/model/device_key.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::results {

using zwidth::decibels;
using zwidth::hertz;

/// 20 log10 of a ratio or of a value in SI units; absent where there is none or it is not positive.
[[nodiscard]] std::optional<double> decibels(std::optional<double> value);

[[nodiscard]] std::optional<double> hertz(std::optional<double> frequency);

/// "kg m²", "N/m", "Hz"; empty for a ratio.
[[nodiscard]] std::string unit_of(Measure measure, Motion motion);

/// "kg", "N s/m", "s", "Hz": the unit of a device file's key, or of a rigid body's fit ("viscous"); empty for a ratio.
[[nodiscard]] std::string parameter_unit(const std::string& key, Motion motion);

/// {"stiffness": "N/m", "damping": "N s/m"}: the units of a document about walls.
[[nodiscard]] Json wall_units(Motion motion);

}  // namespace zwidth::results
