#pragma once

#include <span>
#include <vector>

namespace zwidth::internal {

/// A straight line through equally spaced values, by least squares.
struct StraightLine {
  double middle = 0.0;  ///< value at the middle of the samples
  double slope = 0.0;   ///< per sample
};

/// Requires at least two values.
[[nodiscard]] StraightLine straight_line(std::span<const double> values);

/// The values less their straight line; requires at least two.
[[nodiscard]] std::vector<double> without_line(std::span<const double> values);

}  // namespace zwidth::internal
