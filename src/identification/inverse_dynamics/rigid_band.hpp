#pragma once

#include <optional>
#include <span>

namespace zwidth::internal {

/// Up to where a record of force and position is one of a rigid body; cycles per sample.
struct RigidBand {
  double cutoff = 0.0;
  double lowest = 0.0;   ///< from where on the force excites the body (all but 1 % of its power)
  double highest = 0.0;  ///< up to where it does, and the acceleration stands out of the encoder's noise (99 % of both)
  std::optional<double> first_mode;  ///< where the response turns back: a resonance or an antiresonance
};

/// Cutoff: the frequency below which 99 % of the acceleration's power above the encoder's noise lies, or five times that
/// of half the power (so that the harmonics of Coulomb friction pass) if that is higher; not far above what the force
/// excites (99 % of its power), at most a fifth of the first mode's frequency, where compliance biases an inertia by
/// 4 %, and a tenth of the rate.
[[nodiscard]] RigidBand rigid_band(std::span<const double> force, std::span<const double> position);

}  // namespace zwidth::internal
