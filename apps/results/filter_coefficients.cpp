#include "results/filter_coefficients.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace zwidth::results {

FilterCoefficients in_delta(const FilterSection& section) {
  const std::array<double, 3> numerator = whole_numerator(section);
  const auto degree = static_cast<std::ptrdiff_t>(section.degree);
  FilterCoefficients result{{numerator.begin(), numerator.begin() + degree + 1},
                            {section.denominator.begin(), section.denominator.begin() + degree}};
  result.denominator.push_back(1.0);
  return result;
}

FilterCoefficients in_z(const FilterSection& section) {
  // c0 + c1 (z - 1) + c2 (z - 1)²
  const auto expanded = [](const std::vector<double>& c) {
    if (c.size() == 2) return std::vector{c[1], c[0] - c[1]};
    return std::vector{c[2], c[1] - 2.0 * c[2], c[0] - c[1] + c[2]};
  };
  const FilterCoefficients delta = in_delta(section);
  return {expanded(delta.numerator), expanded(delta.denominator)};
}

double velocity_filter_pole(const Wall& wall, double sampling_period) {
  if (wall.velocity_filter_hz <= 0.0) return 0.0;
  return std::exp(-2.0 * std::numbers::pi * wall.velocity_filter_hz * sampling_period);
}

}  // namespace zwidth::results
