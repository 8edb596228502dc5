#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace internal {
class RegionStructure;
}

/// Every stable wall of a loop: the open set of (K, B), K > 0 and B >= 0, with 1 + (K + B v(z)) P(z) stable.
///
/// Its boundary consists of the curve on which a pole pair lies on the unit circle,
///
///     B(w) = Im(-1/P) / Im v,   K(w) = Re(-1/P) - B Re v,   at z = e^{jwT}, 0 < w < pi/T,
///
/// of the line K + B v(-1) = -1/P(-1) (a pole at z = -1), of K = -1/P(1) (a pole at z = 1), and of K = 0, B = 0.
/// Every B at which the stable intervals of K can change (extrema of B(w), crossings of these curves) is isolated by
/// interval subdivision with bounds on second derivatives (docs/region.md); between two of them the intervals of
/// critical_stiffness() at one B hold for all B, and only their ends move along the curve.
/// Details thinner than 1e-10 of their distance from K = B = 0 are not resolved.
class StableWalls {
 public:
  /// Throws Error (invalid_argument) for a negative or non-finite filter frequency (0: no filter), (did_not_converge)
  /// when subdivision hits its cap.
  explicit StableWalls(FilteredPlant plant, double velocity_filter_hz = 0.0, const Progress& progress = {});

  /// Of a device, with its own velocity filter and filters; of one rate or of two. Where the damper runs in a loop of its
  /// own the boundary is that of theory's plant of two rates, whose curve is followed through slices that miss no
  /// crossing; what lies between two slices and touches neither is not seen (docs/region.md). A point wall, in every
  /// direction that the tip of a mechanism moves, has a curve for each eigenvalue of P in place of -1/P, sampled over w.
  /// Throws as the other one; Error (did_not_converge) too where a curve cannot be followed.
  explicit StableWalls(const Device& device, const Progress& progress = {});

  /// All stable intervals of K at this B >= 0, by rising K: critical_stiffness().stable_intervals at the cost of a few
  /// evaluations of P. Throws Error (invalid_argument) for a negative or NaN B.
  [[nodiscard]] std::vector<StableInterval> stable_stiffnesses(double damping) const;

  /// The velocity filter of the wall whose stiffness and damping vary, Hz; 0: none.
  [[nodiscard]] double velocity_filter_hz() const;

  /// For the functions of this room.
  [[nodiscard]] const internal::RegionStructure& structure() const { return *structure_; }

 private:
  std::shared_ptr<const internal::RegionStructure> structure_;  // never changed once built
};

/// Which of the walls on a grid are stable, 1 or 0; element i * stiffnesses.size() + j is (stiffnesses[j],
/// dampings[i]).
///
/// Exact: no eigenvalues, one look-up of stable intervals per damping. `stiffnesses` must rise; values <= 0 are not
/// stable. Throws Error (invalid_argument) where they do not rise, or a damping is negative or NaN.
[[nodiscard]] std::vector<std::uint8_t> stable_on_grid(const StableWalls& walls, std::span<const double> stiffnesses,
                                                       std::span<const double> dampings);

}  // namespace zwidth
