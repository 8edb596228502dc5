#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

#include "zwidth/model/wall_filter.hpp"

namespace zwidth {

/// A filter as it runs: polynomials in delta = z - 1, which keep their digits where the filter is slow against T.
///
///     F(z) = (delta + 2)^nyquist_zeros (n[0] + n[1] delta + n[2] delta²) / (d[0] + d[1] delta + ... + delta^degree)
///
/// Zeros at z = -1 (every low-pass by Tustin's rule has them) stand apart, where they are exact.
struct FilterSection {
  std::size_t degree = 1;               ///< of the denominator, 1 or 2
  std::size_t nyquist_zeros = 0;        ///< 0 to degree
  std::array<double, 3> numerator{};    ///< degree - nyquist_zeros + 1 coefficients
  std::array<double, 2> denominator{};  ///< monic; the leading 1 is not stored
};

/// Discretises by Tustin's rule with prewarping, see WallFilter; a digital filter as it stands.
/// Throws Error (invalid_argument) where find_problem() finds one.
[[nodiscard]] FilterSection filter_section(const WallFilter& filter, double period);

/// F(e^{j angle}), angle in [0, pi]; exactly 0 at pi where the section has a zero there.
[[nodiscard]] std::complex<double> response(const FilterSection& section, double angle);

/// F(1).
[[nodiscard]] double static_gain(const FilterSection& section);

/// All degree + 1 coefficients of the numerator in delta, the zeros at z = -1 multiplied in.
[[nodiscard]] std::array<double, 3> whole_numerator(const FilterSection& section);

/// A section as a quotient of polynomials, degree + 1 coefficients each, the denominator monic.
struct FilterCoefficients {
  std::vector<double> numerator;    ///< by rising powers of 1/z
  std::vector<double> denominator;  ///< by rising powers of 1/z, the first one 1
};

/// In delta = z - 1 by rising powers: every digit of the section.
[[nodiscard]] FilterCoefficients in_delta(const FilterSection& section);

/// In z by falling powers: the textbook form, which rounds away digits of a filter that is slow against the sampling
/// period.
[[nodiscard]] FilterCoefficients in_z(const FilterSection& section);

/// The pole of the low-pass on a wall's velocity, (1 - a)/(1 - a z^-1); 0 for 0 Hz, without one.
///
///     a = exp(-2 pi f_c T)
[[nodiscard]] double velocity_filter_pole(double cutoff_hz, double sampling_period);

/// The gain 1 - a of that low-pass, with its digits where a is near 1; 1 for 0 Hz.
[[nodiscard]] double velocity_filter_gain(double cutoff_hz, double sampling_period);

}  // namespace zwidth
