#pragma once

#include <optional>
#include <vector>

#include "zwidth/design/stable_walls.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// The stiffest wall at one B that is stable with every passive user (see absolute_stability_limit()).
struct AbsoluteStabilityPoint {
  double damping = 0.0;    ///< B
  double stiffness = 0.0;  ///< the limit of K; 0 at the ends of a range of B
  double frequency = 0.0;  ///< rad/s, where the worst user destabilises it; 0 where the limit is 0
};

/// The walls (K, B) that no passive user destabilises: those below the limit.
struct AbsoluteStabilityRegion {
  std::vector<std::vector<AbsoluteStabilityPoint>> ranges;  ///< per range of B with a limit above 0, by rising B
  std::optional<AbsoluteStabilityPoint> stiffest;           ///< among the points
  std::optional<AbsoluteStabilityPoint> most_damped;        ///< end of the last range
  double area = 0.0;                                        ///< in (K, B), of the polygons
  /// The limit is a lower bound: some walls above it may be stable with every passive user too.
  bool is_bound = false;
  /// Of the limit of which most was taken off, where that is above the deviation. Refused, with no ranges, where the limit is
  /// not known at some B.
  Trust trust = {};
};

/// How finely the region for any passive user is traced.
struct AbsoluteStabilityRegionOptions {
  double deviation = 1e-3;  ///< aimed distance of the limit from the polygon, as a share of its extent in K and in B
  Progress progress = {};   ///< told how far the work is; ends it by throwing
};

/// Samples absolute_stability_limit() over 0 <= B <= largest_damping, more densely where it bends, and never above the stable walls
/// of the device by itself, which `walls` are. A range of B narrower than a factor of 1.5 may be missed between samples; not where
/// a faster damper runs in a loop of its own, whose ranges begin and end where the damper alone does, frequency by frequency. Its
/// limit is that of analyze(): a lower bound where the delays differ by no whole periods of the damper.
/// Throws Error (needs_bodies) for a transfer function, (invalid_argument) for a largest_damping <= 0 or infinite, a
/// deviation outside (0, 1), and for a damper slower than its spring.
[[nodiscard]] AbsoluteStabilityRegion absolute_stability_region(const Device& device, const StableWalls& walls,
                                                                double largest_damping,
                                                                const AbsoluteStabilityRegionOptions& options = {});

}  // namespace zwidth
