#pragma once

#include <string>
#include <string_view>

#include "results/units.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::report {

using results::parameter_unit;
using zwidth::decibels;
using zwidth::hertz;
using zwidth::number;
using zwidth::quantity;
using zwidth::Units;
using zwidth::units_of;

/// Where a pole leaves the unit circle, from rad/s: "6.143 Hz (38.6 rad/s)", or "0 Hz (a real pole at rest)".
[[nodiscard]] std::string crossover_frequency_text(double frequency);

/// "8.849 kN/m", "none" of 0, "unbounded", "refused" of NaN.
[[nodiscard]] std::string limit_value_text(double limit, std::string_view unit);

/// "rigid body", "mode 1".
[[nodiscard]] std::string short_name(const Oscillator& oscillator);
/// "the rigid body", "vibration mode 1".
[[nodiscard]] std::string long_name(const Oscillator& oscillator);

/// A parameter's value with its unit: "0.3 kg", "250 µs".
[[nodiscard]] std::string parameter_text(const std::string& key, double value, Motion motion);

/// Of a share, 0..1: "34.21 %", with as many digits as tell it from 0 % and from 100 %.
[[nodiscard]] std::string share_of_all_text(double share);

/// By what a number changes, of its factor: "+23.1 %", "-12 %", and from twice and half on "x 2.5", "/ 3.7".
[[nodiscard]] std::string factor_text(double factor);

}  // namespace zwidth::report
