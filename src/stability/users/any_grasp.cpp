#include "stability/users/any_grasp.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "stability/loop/damper_response.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/tip_motion.hpp"

namespace zwidth::internal {

bool is_grasped_in_many_directions(const Device& device) {
  const std::optional<TipMotion> motion = tip_motion_of(device);
  if (!motion) return false;
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

AnyGrasp::AnyGrasp(const Device& device)
    : plant_(tip_motion_of(device).value(), device_without_user(device).parameters(), wall_normal(device)),
      filters_(filtered_plant(with_one_rate(device_without_user(device)))),
      period_(device.loop().sampling_period) {}

AbsoluteStabilityLimit AnyGrasp::limit(FreeGain gain, VirtualDamper damper, const CriticalStiffness& nobody) const {
  AbsoluteStabilityLimit limit;
  limit.trust = nobody.trust;
  limit.stiffness = nobody.stiffness;
  if (std::isnan(nobody.stiffness) || nobody.stiffness == 0.0) return limit;
  const GraspLimit grasp = plant_.least_gain([&](double frequency) {
    const std::complex<double> filters = filter_response(filters_, frequency * period_);
    const std::complex<double> velocity = filters * damper_response(damper, period_, frequency);
    return gain == FreeGain::damping ? GraspedPlant::Wall{velocity, 0.0} : GraspedPlant::Wall{filters, velocity};
  });
  if (std::isnan(grasp.stiffness)) {
    limit.stiffness = grasp.stiffness;
    limit.trust.refuse({.code = FindingCode::any_grasp_not_known});
    return limit;
  }
  limit.needs_no_user = nobody.stiffness <= grasp.stiffness;
  if (!limit.needs_no_user) limit.stiffness = grasp.stiffness;
  if (limit.stiffness == 0.0 || std::isinf(limit.stiffness)) return limit;
  if (!limit.needs_no_user) {
    limit.frequency = grasp.frequency;
  } else if (nobody.limit) {
    limit.frequency = nobody.limit->frequency;
  }
  return limit;
}

std::optional<AbsoluteStabilityLimit> any_grasp_absolute_stability(const Device& device, VirtualDamper damper,
                                                                   const CriticalStiffness& nobody) {
  const bool is_apart = has_damper_loop(device.loop()) && damper.damping > 0.0;
  if (is_apart || !is_of_mechanism(device)) return std::nullopt;
  const AbsoluteStabilityLimit limit = AnyGrasp(device).limit(AnyGrasp::FreeGain::stiffness, damper, nobody);
  if (std::isnan(limit.stiffness) && !std::isnan(nobody.stiffness)) return std::nullopt;
  return limit;
}

}  // namespace zwidth::internal
