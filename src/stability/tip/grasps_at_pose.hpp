#pragma once

#include <Eigen/Core>
#include <vector>

#include "stability/tip/grasp_search.hpp"
#include "stability/tip/posed_tip.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth::internal {

// Any grasp of the tip, with the damper of the wall.
class GraspsAtPose {
 public:
  GraspsAtPose(const TipMotion& motion, const DeviceParameters& loop);

  [[nodiscard]] GraspLimit along(const Eigen::Vector3d& normal) const;
  // To fewer digits, for many directions.
  [[nodiscard]] GraspLimit quickly_along(const Eigen::Vector3d& normal) const;
  [[nodiscard]] PointGraspLimit of_point() const;

 private:
  [[nodiscard]] GraspLimit limit_of(const GraspSearch::Least& least) const;

  PosedTip posed_;
  GraspSearch search_;
  GraspSearch::Wall wall_;
};

// What users leave: at the pose, or at each of those beside it.
[[nodiscard]] std::vector<GraspsAtPose> grasps_of(const TipMotion& motion, const DeviceParameters& loop,
                                                  GraspedPose pose);

// NaN where either is not known.
[[nodiscard]] GraspLimit lesser(const GraspLimit& a, const GraspLimit& b);

}  // namespace zwidth::internal
