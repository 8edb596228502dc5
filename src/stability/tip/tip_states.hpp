#pragma once

// The tip of a mechanism as states, with a wall along some directions: in continuous time, and sampled with its delay and
// damper.

#include <Eigen/Core>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/model/tip_motion.hpp"

namespace zwidth::internal {

// Throws Error (invalid_argument) for a normal along which the tip cannot move.
void require_tip_moves_along(const TipMotion& motion, const Eigen::Vector3d& normal);

// The motion that users grasp: itself, or at a singular pose one with the tip of each pose beside it.
[[nodiscard]] std::vector<TipMotion> grasped_motions(const TipMotion& motion);

// In coordinates in which M is 1: z'' + D z' + K z = pushed' f + tip' f_h, along m directions.
struct TipCoordinates {
  Eigen::MatrixXd stiffness;  // K, n x n
  Eigen::MatrixXd damping;    // D
  Eigen::MatrixXd sensed;     // m x n
  Eigen::MatrixXd pushed;
  Eigen::MatrixXd tip;
  Eigen::Index unseen = 0;  // the first ones: no spring holds them, and the wall does not see them
};
// Throws Error (invalid_argument) as Device does for masses and elements.
[[nodiscard]] TipCoordinates tip_coordinates(const TipMotion& motion, const Eigen::MatrixXd& directions,
                                             const User& user = {});

// Sampled, in delta = z - 1: x+ = (1 + Phi) x + Gamma1 u[k-l] + Gamma2 u[k-l-1], y = C x. Positions that neither a spring nor
// the wall knows are no states: they stay free (z = 1).
struct SampledTip {
  double period = 0.0;
  Eigen::MatrixXd Phi;
  Eigen::MatrixXd Gamma1;
  Eigen::MatrixXd Gamma2;  // 0 for a whole number of samples
  Eigen::MatrixXd C;
  Eigen::Index delay_samples = 0;
  [[nodiscard]] bool has_fraction() const { return Gamma2.size() > 0; }
};
[[nodiscard]] SampledTip sampled_tip(const TipCoordinates& of, const DeviceParameters& loop);
// In all directions in which the tip of such a device moves, with its user. Throws Error (invalid_argument) where
// require_plain_wall() does of any damper.
[[nodiscard]] SampledTip tip_of_point_wall(const Device& device);

// The loop of a gain g behind a closed damper: x+ = (1 + state - g input output) x.
struct GainLoop {
  Eigen::MatrixXd state;
  Eigen::MatrixXd input;   // forces over `unit`
  Eigen::MatrixXd output;  // m
  double unit = 1.0;       // N/m: what a gain of 1 is
  double period = 0.0;
};
// Of the wall's stiffness in all those directions; the wall's damper is closed.
[[nodiscard]] GainLoop stiffness_loop(const SampledTip& plant, const Wall& wall);
// Of the whole wall, stiffness and damper: a gain of 1 is the wall itself.
[[nodiscard]] GainLoop wall_loop(const SampledTip& plant, const Wall& wall);

// Throws Error (invalid_argument) for what walls in several directions do not know: filters on the wall's force, a damper
// in a loop of its own.
void require_plain_wall(const DeviceParameters& loop);

}  // namespace zwidth::internal
