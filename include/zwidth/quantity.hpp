#pragma once

#include <string>
#include <string_view>

#include "zwidth/model/device.hpp"

namespace zwidth {

/// Names of the units of a device's quantities, by its motion.
struct Units {
  std::string_view stiffness;  ///< "N/m" or "N m/rad"
  std::string_view damping;    ///< "N s/m" or "N m s/rad"
  std::string_view mass;       ///< "kg" or "kg m²"
  std::string_view force;      ///< "N" or "N m"
  std::string_view length;     ///< "m" or "rad"
};
[[nodiscard]] Units units_of(Motion motion);  ///< SI

/// Four significant digits without trailing zeros, and those before the point up to five: "38.6", "31416", "1.2e-07".
[[nodiscard]] std::string number(double value);

/// A number with an engineering prefix, n to G, below 1 n with none: quantity(8848.7, "N/m") is "8.849 kN/m".
[[nodiscard]] std::string quantity(double value, std::string_view unit);

/// 20 log10 of a ratio or of a value in SI units; value > 0.
[[nodiscard]] double decibels(double value);

/// 10^(d/20): the ratio of d decibels.
[[nodiscard]] double ratio_of_decibels(double value);

/// w / (2 pi): rad/s to Hz, and back.
[[nodiscard]] double hertz(double frequency);
[[nodiscard]] double radians_per_second(double cycles);  ///< of Hz

/// 180 w / pi: rad to degrees, and back.
[[nodiscard]] double degrees(double angle);
[[nodiscard]] double radians(double angle);  ///< of degrees

}  // namespace zwidth
