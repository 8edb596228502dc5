#pragma once

#include <Eigen/Core>

#include "stability/tip/tip_states.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {

// The tip at its pose: the directions in which it can move, and what it does there in the loop without its user.
struct PosedTip {
  // Refuses a tip that stands still, and a wall that is none of stiffness and damping.
  PosedTip(const TipMotion& of, const DeviceParameters& with);

  // In the tip's directions, padded with 0. Refuses a direction in which the tip does not move.
  [[nodiscard]] Eigen::Vector3d along(const Eigen::Vector3d& normal) const;

  [[nodiscard]] VirtualDamper damper() const { return {loop.wall.damping, loop.wall.velocity_filter_hz}; }

  TipMotion motion;
  DeviceParameters loop;
  Eigen::MatrixXd directions;
  SampledTip plant;
};

}  // namespace zwidth::internal
