#pragma once

#include <span>

namespace zwidth::internal {

/// Frequencies below which these parts of the acceleration's power lie, as fractions of the rate, in (0, 0.5].
struct MotionBandwidth {
  double half = 0.0;        ///< 50 %
  double nearly_all = 0.0;  ///< 99 %
};

/// Counted is power above the position's noise, taken as white and judged from the upper half of the spectrum, and only
/// up to where the motion first sinks into that noise. Requires at least 100 finite samples that are not all equal.
[[nodiscard]] MotionBandwidth motion_bandwidth(std::span<const double> position);

}  // namespace zwidth::internal
