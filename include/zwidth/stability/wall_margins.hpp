#pragma once

#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth {

/// A frequency at which the loop gain |L| is 1.
struct GainCrossover {
  double frequency = 0.0;     ///< rad/s
  double phase_margin = 0.0;  ///< rad, in (-pi, pi]: angle of L plus pi
};

/// How far a loop L under negative feedback is from instability. Margins are absent when the loop is unstable.
struct LoopMargins {
  bool stable = false;                      ///< every closed-loop pole inside the unit circle
  std::optional<double> gain_margin;        ///< least factor > 1 on L that destabilises; absent: none does
  std::optional<double> lower_gain_margin;  ///< largest factor in (0, 1) that destabilises; absent: none does
  std::optional<double>
      stiffness_margin;                ///< least factor > 1 on K alone, B held, that destabilises; absent: none does
  std::optional<double> phase_margin;  ///< rad > 0; least phase, either way, over all gain crossovers
  std::optional<double> delay_margin;  ///< s; min over all gain crossovers of phase lag to -180 degrees / frequency
  std::vector<GainCrossover> gain_crossovers;  ///< all, by rising frequency
};

/// The verdict on a given wall.
struct WallMargins : LoopMargins {
  double stiffness = 0.0;  ///< K
  double damping = 0.0;    ///< B
  /// Largest closed-loop |z|; with K = 0 but the pole at z = 1 of a free position, and but those of motions of a
  /// mechanism that the wall leaves free
  double spectral_radius = 0.0;
  /// With a damper in a loop of its own, s: the least delay of the spring's force alone that destabilises
  std::optional<double> spring_delay_margin = {};
  std::optional<double> damper_delay_margin = {};  ///< the same of the damper's force alone
};

/// Margins of L(z) = C(z) P(z), C(z) = K + B v(z) as in Wall; every gain and phase crossover is found as in
/// critical_stiffness().
///
/// The delay margin treats the added delay as e^{-jw tau} on the sampled loop: exact for whole samples; a fraction of a
/// sample changes the response itself, which only wall_margins() of the device can follow.
/// Stable means all closed-loop poles strictly inside the unit circle; with K = 0 but the one at z = 1 of a position that
/// nothing holds. With K = 0 the gain margins are those of B.
/// Throws Error (invalid_argument) when wall.stiffness is absent or a value is outside its domain.
[[nodiscard]] LoopMargins loop_margins(const FilteredPlant& plant, const Wall& wall);

/// Margins of the device's own wall, and the closed loop's spectral radius by eigenvalues.
///
/// The delay margin is exact for any real delay: the least added delay at which a closed-loop pole of the plant sampled
/// with that delay (modified z-transform) lies on the unit circle, over all crossovers.
///
/// With a damper in a loop of its own the loop is cut where the slower of spring and damper acts: the phase margin and
/// gain_crossovers are of that force alone, the other one closed. gain_margin and lower_gain_margin are left out;
/// stiffness_margin stands. The delay margin is of both forces at once, and each has one of its own; all are found by
/// eigenvalues, and absent beyond 16 of the longer periods, or where the loop then has more than 80 states. The spectral
/// radius is per sampling period of the spring.
/// Throws Error (invalid_argument) when the device has no wall stiffness.
[[nodiscard]] WallMargins wall_margins(const Device& device);

}  // namespace zwidth
