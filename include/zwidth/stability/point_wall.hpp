#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/wall_margins.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// The stiffest stable wall that acts in every direction that the tip can move: a point that holds the tip.
struct PointWallLimit {
  StiffnessStatus status = StiffnessStatus::refused;  ///< whether there is a limit
  double stiffness = 0.0;  ///< K_CR, N/m; 0 when none_stable, infinity when unbounded, NaN when refused
  double frequency = 0.0;  ///< rad/s, of the pole on the unit circle at K_CR, in [0, pi/T]; 0 unless finite
  /// Along which the tip, as the controller knows it, then shakes most; of length 1, world's frame; 0 unless finite
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  Trust trust = {};  ///< refused where poles run so close along the circle that no number is shown to be the least
};

/// K_CR of a point wall at one pose, with the wall's damper closed in the same directions and the user, if any, there.
///
///     det(1 + (K + B v(z)) P(z)) = 0,   P = S_s (M s^2 + C s + K_s)^-1 S_a' with hold and delay, m x m
///
/// It is not the least over normals. `loop` gives sampling, delay, actuator's lag, wall's damper and user, who holds the
/// tip alike in all directions; bodies and which points the loop names are not read. Complete: from K = 0 upwards each
/// interval of stable stiffnesses is certain by the small-gain theorem and touches the next; the last ends a relative 1e-7
/// below K_CR, which closed-loop eigenvalues give to rounding. Positions in which the wall does not act stay free.
/// Throws Error (invalid_argument) for filters of the wall, a damper in a loop of its own and impossible numbers, and where
/// the tip cannot move. Source: docs/theory.md, "Several axes".
[[nodiscard]] PointWallLimit point_wall_limit(const TipMotion& motion, const DeviceParameters& loop);

/// Along one normal alone, in the same way: what critical_stiffness() says of that device, by another route.
[[nodiscard]] PointWallLimit normal_wall_limit(const TipMotion& motion, const DeviceParameters& loop,
                                               const Eigen::Vector3d& normal);

/// How far a point wall of stiffness K and damping B is from instability; factors, phases and delays are those of all
/// directions at once. Stable: every pole inside the unit circle, but those of positions that nothing holds.
struct PointWallMargins : LoopMargins {
  double spectral_radius = 0.0;  ///< the largest |z|
  /// That a margin of a stable wall is absent where none is, and gain_crossovers are all; else some were not found
  bool margins_are_known = false;
};

/// Of the wall in `loop`.
///
///     gain crossovers: |l| = 1 of an eigenvalue l of L = (K + B v) P on |z| = 1;  phase margin: |arg(-l)|
///     they are where an eigenvalue of T = L (1 + L)^-1 has the real part 1/2
///
/// All are found: between them intervals of angle are excluded by a bound on T, of closed-loop poles. The delay margin is
/// the least delay that, added to that of every direction, puts a pole of the loop sampled with it on the circle: exact for
/// any fraction of a sample, as wall_margins(). gain_margin, and lower_gain_margin below 1, are of K and B together.
/// Factors and delays that differ from direction to direction are not known.
/// Throws Error (invalid_argument) as point_wall_limit(), and without a wall's stiffness > 0.
[[nodiscard]] PointWallMargins point_wall_margins(const TipMotion& motion, const DeviceParameters& loop);

/// The limit at each of these damping values: the border of the stable region in (K, B) that touches K = 0.
[[nodiscard]] std::vector<PointWallLimit> point_wall_limits(const TipMotion& motion, const DeviceParameters& loop,
                                                            const std::vector<double>& dampings);

}  // namespace zwidth
