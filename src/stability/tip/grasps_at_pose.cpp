#include "stability/tip/grasps_at_pose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "stability/loop/damper_response.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth {
namespace internal {

GraspsAtPose::GraspsAtPose(const TipMotion& motion, const DeviceParameters& loop)
    : posed_(motion, loop),
      search_(posed_.motion, posed_.loop, posed_.directions, posed_.plant),
      wall_(search_.wall([damper = posed_.damper(), period = posed_.plant.period](double angle) {
        return WallResponse{1.0, damper_response(damper, period, angle / period)};
      })) {}

GraspLimit GraspsAtPose::along(const Eigen::Vector3d& normal) const {
  return limit_of(GraspSearch::Along(search_, posed_.along(normal)).least(wall_));
}

GraspLimit GraspsAtPose::quickly_along(const Eigen::Vector3d& normal) const {
  return limit_of(GraspSearch::Along(search_, posed_.along(normal)).quickly_least(wall_));
}

PointGraspLimit GraspsAtPose::of_point() const {
  const auto [least, most] = search_.least_of_point(posed_.directions.cols(), posed_.damper());
  return {least.gain, most.gain, limit_of(least).frequency};
}

GraspLimit GraspsAtPose::limit_of(const GraspSearch::Least& least) const {
  return {least.gain, frequency_of(least, posed_.plant.period)};
}

std::vector<GraspsAtPose> grasps_of(const TipMotion& motion, const DeviceParameters& loop, GraspedPose pose) {
  std::vector<GraspsAtPose> grasps;
  if (pose == GraspedPose::alone) {
    grasps.emplace_back(motion, loop);
    return grasps;
  }
  for (const TipMotion& each : grasped_motions(motion)) grasps.emplace_back(each, loop);
  return grasps;
}

GraspLimit lesser(const GraspLimit& a, const GraspLimit& b) {
  return b.stiffness < a.stiffness || std::isnan(b.stiffness) ? b : a;
}

}  // namespace internal

GraspLimit any_grasp_limit(const TipMotion& motion, const DeviceParameters& loop, const Eigen::Vector3d& normal,
                           GraspedPose pose) {
  internal::require_tip_moves_along(motion, normal);
  GraspLimit least{.stiffness = std::numeric_limits<double>::infinity()};
  for (const internal::GraspsAtPose& each : internal::grasps_of(motion, loop, pose))
    least = internal::lesser(least, each.along(normal));
  return least;
}

PointGraspLimit any_grasp_limit_of_point(const TipMotion& motion, const DeviceParameters& loop, GraspedPose pose) {
  PointGraspLimit least{.at_least = std::numeric_limits<double>::infinity(),
                        .at_most = std::numeric_limits<double>::infinity()};
  for (const internal::GraspsAtPose& each : internal::grasps_of(motion, loop, pose)) {
    const PointGraspLimit here = each.of_point();
    if (here.at_least < least.at_least) {
      least.at_least = here.at_least;
      least.frequency = here.frequency;
    }
    least.at_most = std::min(least.at_most, here.at_most);
  }
  return least;
}

}  // namespace zwidth
