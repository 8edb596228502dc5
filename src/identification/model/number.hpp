#pragma once

#include <cmath>
#include <limits>
#include <string>

namespace zwidth::internal {

/// A factor of 28 either way at one sigma: what is believed of a mass or a link's stiffness before its record, as the deviation of
/// its logarithm. An assumption, weak on purpose.
inline constexpr double deviation_of_logarithm = 3.3;

/// A number of the fit: of the device, by its key, or of a rival, by a name of its own ("drag.motor").
struct Number {
  static constexpr double least_square = 1e-4;  ///< of what acts in the second order alone
  enum class Scale {
    logarithmic,   ///< value = unit exp(x): masses and stiffnesses of links
    not_negative,  ///< value = unit x, x >= 0: what may be 0
    any,           ///< value = unit x
    square,        ///< value = unit sqrt(x), x >= a little: what acts in the second order alone
  };
  std::string key;
  Scale scale = Scale::not_negative;
  double unit = 1.0;  ///< a typical value
  /// What is believed beforehand: x is normal about `expected`, cut at its bound.
  double expected = 0.0;
  double prior_deviation = std::numeric_limits<double>::infinity();  ///< of x; infinite: nothing is believed
  double start =
      0.0;  ///< x that a fit starts from, where no device gives it: off a value at which nothing changes with x

  [[nodiscard]] double value(double x) const {
    if (scale == Scale::square) return unit * std::sqrt(std::fmax(x, least_square));
    return scale == Scale::logarithmic ? unit * std::exp(x) : unit * x;
  }
  [[nodiscard]] double coordinate(double value) const {
    constexpr double least = 1e-12;
    if (scale == Scale::square) return std::fmax(std::pow(value / unit, 2), least_square);
    return scale == Scale::logarithmic ? std::log(std::fmax(value / unit, least)) : value / unit;
  }
  [[nodiscard]] double slope(double x) const {
    if (scale == Scale::square) return 0.5 * unit / std::sqrt(std::fmax(x, least_square));
    return scale == Scale::logarithmic ? value(x) : unit;
  }
  [[nodiscard]] double lowest() const {
    if (scale == Scale::square) return least_square;
    return scale == Scale::not_negative ? 0.0 : -std::numeric_limits<double>::infinity();
  }
};

}  // namespace zwidth::internal
