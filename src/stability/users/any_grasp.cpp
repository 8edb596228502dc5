#include "stability/users/any_grasp.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "stability/users/grasp_search.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth::internal {

bool is_grasped_in_many_directions(const Device& device) {
  const std::optional<TipMotion> motion = tip_motion_of(device);
  if (!motion || !device.parameters().mechanism) return false;
  return tip_directions(*motion).cols() > 1 || !motion->tips_beside.empty();
}

std::vector<Remark> any_grasp_remarks(const Device& device, bool is_known) {
  std::vector<Remark> remarks;
  if (!device.parameters().coordinates) return remarks;
  if (is_pose_singular(device)) remarks.push_back(singular_pose_remark(tip_motion_of(device).value()));
  if (!is_known) {
    remarks.push_back(note({.code = FindingCode::any_grasp_not_known}));
  } else if (is_grasped_in_many_directions(device)) {
    remarks.push_back(note({.code = FindingCode::any_grasp_scanned}));
  }
  return remarks;
}

bool is_pose_singular(const Device& device) {
  const std::optional<TipMotion> motion = tip_motion_of(device);
  return motion && !motion->tips_beside.empty();
}

Remark singular_pose_remark(const TipMotion& motion, std::optional<double> at_pose, std::optional<double> beside) {
  Eigen::Index directions = 0;
  for (const Eigen::MatrixXd& each : motion.tips_beside) directions = std::max(directions, tip_directions(each).cols());
  Finding lost{.code = FindingCode::tip_loses_directions,
               .evidence = {{"directions", static_cast<double>(tip_directions(motion).cols())},
                            {"directions_beside", static_cast<double>(directions)}}};
  if (at_pose && beside) {
    lost.evidence.push_back({"at_pose", *at_pose, "N/m"});
    lost.evidence.push_back({"beside", *beside, "N/m"});
  }
  return warning(std::move(lost));
}

std::optional<AbsoluteStabilityLimit> any_grasp_absolute_stability(const Device& device, VirtualDamper damper,
                                                                   const CriticalStiffness& nobody) {
  const std::optional<TipMotion> motion = tip_motion_of(device);
  if (!motion || !device.parameters().mechanism) return std::nullopt;
  DeviceParameters loop = device.parameters();
  const bool is_apart = has_damper_loop(loop.loop) && damper.damping > 0.0;
  if (is_apart) return std::nullopt;
  if (!loop.wall.filters.empty() && nobody.stiffness > 0.0) {
    AbsoluteStabilityLimit limit =
        GraspSearch(device_without_user(device)).limit(GraspSearch::FreeGain::stiffness, damper, nobody);
    limit.trust = nobody.trust;
    return limit;
  }
  loop.loop.damper.reset();
  loop.wall.damping = damper.damping;
  loop.wall.velocity_filter_hz = damper.velocity_filter_hz;
  AbsoluteStabilityLimit limit;
  limit.trust = nobody.trust;
  limit.stiffness = nobody.stiffness;
  if (std::isnan(nobody.stiffness) || nobody.stiffness == 0.0) return limit;
  const Eigen::Vector3d normal(loop.mechanism->normal.data());
  const GraspLimit grasp = any_grasp_limit(*motion, loop, normal);
  limit.needs_no_user = nobody.stiffness <= grasp.stiffness;
  limit.stiffness = std::min(nobody.stiffness, grasp.stiffness);
  if (limit.stiffness == 0.0 || std::isinf(limit.stiffness)) return limit;
  if (!limit.needs_no_user) {
    limit.frequency = grasp.frequency;
  } else if (nobody.limit) {
    limit.frequency = nobody.limit->frequency;
  }
  return limit;
}

}  // namespace zwidth::internal
