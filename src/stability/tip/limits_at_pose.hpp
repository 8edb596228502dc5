#pragma once

// The limits of walls along one normal after another, at one pose: what is of the pose is computed once.

#include <Eigen/Core>
#include <memory>

#include "zwidth/model/device.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth::internal {

// As limits_along(), which says how far its numbers go; throws as it does.
class LimitsAtPose {
 public:
  LimitsAtPose(const TipMotion& motion, const DeviceParameters& loop, const NormalLimitsOptions& options = {});
  ~LimitsAtPose();
  LimitsAtPose(const LimitsAtPose&) = delete;
  LimitsAtPose& operator=(const LimitsAtPose&) = delete;

  // With nobody holding; without the other limit.
  [[nodiscard]] NormalLimits nobody_along(const Eigen::Vector3d& normal) const;
  // With any passive grasp; needs NormalLimitsOptions::any_grasp.
  [[nodiscard]] GraspLimit any_grasp_along(const Eigen::Vector3d& normal) const;

 private:
  struct Scans;
  std::unique_ptr<const Scans> scans_;
};

}  // namespace zwidth::internal
