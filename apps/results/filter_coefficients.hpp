#pragma once

#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth::results {

/// A section as a quotient of polynomials.
struct FilterCoefficients {
  std::vector<double> numerator;
  std::vector<double> denominator;
};

/// In delta = z - 1 by rising powers, degree + 1 each, the denominator monic: every digit of the section.
[[nodiscard]] FilterCoefficients in_delta(const FilterSection& section);

/// In z by falling powers, degree + 1 each, the denominator monic: the textbook form, which rounds away digits of a
/// filter that is slow against the sampling period.
[[nodiscard]] FilterCoefficients in_z(const FilterSection& section);

/// a of the low-pass (1 - a)/(1 - a z^-1) on the damper's velocity, exp(-2 pi f_c T); 0 without one.
[[nodiscard]] double velocity_filter_pole(const Wall& wall, double sampling_period);

}  // namespace zwidth::results
