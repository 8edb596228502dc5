#pragma once

#include <cstddef>
#include <span>

namespace zwidth::internal {

/// The end of a record in which an oscillation no longer changes its swing.
struct SteadyPart {
  std::size_t from = 0;  ///< first sample
  /// Relative standard deviation of the swing over the stretches of the last half.
  double scatter = 0.0;
  /// Relative change of the swing over the last half, by a straight line through its stretches.
  double trend = 0.0;
};

/// Swing: rms about a straight line over each stretch, counted from the record's end. Steady from the first stretch
/// after which every swing is within max(tolerance, 3 scatter) of the last half's mean. At most the first half is left
/// out. Requires a stretch of at least 4 samples that fits four times into half the record.
[[nodiscard]] SteadyPart steady_part(std::span<const double> position, std::size_t stretch, double tolerance);

}  // namespace zwidth::internal
