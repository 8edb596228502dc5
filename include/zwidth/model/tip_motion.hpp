#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "zwidth/model/coordinates.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth {

/// How the tip of a mechanism at a pose moves, is read and is pushed in all directions at once, in n coordinates q.
///
///     M q'' + (sum d w w') q' + (sum k w w') q = S_a' f + J' f_h,   x = S_s q,   x_tip = J q
///
/// f: the controller's force, x: the tip as the controller knows it, f_h: the user's force. World's frame, m and N. Source:
/// docs/theory.md, "Several axes" (S_s = J_e A, S_a = J_m A).
struct TipMotion {
  Eigen::MatrixXd mass;                        ///< M, n x n; symmetric and positive definite
  std::vector<Coordinates::Element> elements;  ///< all that is stiff or damped
  Eigen::MatrixXd sensed;                      ///< S_s, 3 x n
  Eigen::MatrixXd pushed;                      ///< S_a, 3 x n
  Eigen::MatrixXd tip;                         ///< J, 3 x n
  /// Of a singular pose: J towards poses beside it, where the tip moves along more directions; else empty
  std::vector<Eigen::MatrixXd> tips_beside = {};
};

/// That of a device of a mechanism, in the directions in which its wall acts; nothing of any other device.
[[nodiscard]] std::optional<TipMotion> tip_motion_of(const Device& device);

/// Whether it is that of a mechanism at a pose, whose user grasps the tip in every direction.
[[nodiscard]] bool is_of_mechanism(const Device& device);

/// The normal of its wall, of any length; 0 of a wall in every direction, and of any other device.
[[nodiscard]] Eigen::Vector3d wall_normal(const Device& device);

/// What the tip moves less of, relative to the direction in which it moves most, is a direction in which it cannot.
inline constexpr double tip_stands_below = 1e-6;

/// The directions in which the tip can move by J, 3 x n: orthonormal columns in the world's frame; none where it stands still.
[[nodiscard]] Eigen::MatrixXd tip_directions(const Eigen::MatrixXd& tip);
/// The same of a motion's own J.
[[nodiscard]] Eigen::MatrixXd tip_directions(const TipMotion& motion);

/// Whether the tip can move along a normal of any length > 0.
[[nodiscard]] bool tip_moves_along(const Eigen::MatrixXd& tip, const Eigen::Vector3d& normal);

}  // namespace zwidth
