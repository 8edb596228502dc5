#include "stability/point_wall_analysis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "model/implausible_numbers.hpp"
#include "stability/tip/gain_march.hpp"
#include "stability/tip/tip_states.hpp"
#include "stability/users/any_grasp.hpp"
#include "stability/wall_judgement.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/stability/point_wall.hpp"

namespace zwidth::internal {
namespace {

constexpr double most_samples_confirmed = 40.0;  // of further delay: beyond, there are too many states

HolderLimit holder_limit_of(const PointWallLimit& limit) {
  HolderLimit of{.critical_stiffness = limit.stiffness};
  if (limit.status == StiffnessStatus::finite) of.frequency = limit.frequency;
  return of;
}

// A damper of the same period and delay as the spring, or none, is no loop of its own.
DeviceParameters loop_of(const Device& device) {
  DeviceParameters loop = device.parameters();
  if (!runs_damper_apart(loop)) loop.loop.damper.reset();
  return loop;
}

// The loop with further delay, or with its force turned, by closed-loop poles.
void confirm(const TipMotion& motion, const DeviceParameters& loop, Analysis& analysis) {
  constexpr double closeness = 1e-6;
  constexpr double rounding = 1e-11;
  WallMargins& wall = *analysis.wall;
  const TipCoordinates of = tip_coordinates(motion, tip_directions(motion), loop.user);
  if (wall.delay_margin && *wall.delay_margin < most_samples_confirmed * loop.loop.sampling_period) {
    const auto excess_at = [&](double share) {
      DeviceParameters later = loop;
      later.loop.delay += share * *wall.delay_margin;
      return stability_excess(wall_loop(sampled_tip(of, later), loop.wall), 1.0);
    };
    if (excess_at(1.0 - closeness) > rounding || excess_at(1.0 + closeness) < -rounding) {
      wall.delay_margin.reset();
      analysis.trust.doubt({.code = FindingCode::delay_margin_contradicts});
    }
  }
  const GainLoop whole = wall_loop(sampled_tip(of, loop), loop.wall);
  const double margin = wall.phase_margin.value_or(std::numbers::pi);
  const auto is_unstable_at = [&](double share) {
    return stability_excess_at(whole, std::polar(1.0, -share * margin)) > rounding;
  };
  if (std::ranges::none_of(std::array{0.05, 0.1, 0.3, 0.6, 1.0 - 1e-4}, is_unstable_at)) return;
  wall.phase_margin.reset();
  wall.delay_margin.reset();
  analysis.trust.doubt({.code = FindingCode::margins_contradict});
}

void judge_point_wall(const TipMotion& motion, const DeviceParameters& loop, const DeviceParameters& alone,
                      Analysis& analysis) {
  if (!(loop.wall.stiffness.value_or(0.0) > 0.0)) return;
  const PointWallMargins margins = point_wall_margins(motion, loop);
  WallMargins& wall = analysis.wall.emplace();
  wall.stiffness = *loop.wall.stiffness;
  wall.damping = loop.wall.damping;
  static_cast<LoopMargins&>(wall) = static_cast<const LoopMargins&>(margins);
  wall.spectral_radius = margins.spectral_radius;
  if (margins.stable && !margins.margins_are_known) {
    analysis.remarks.push_back(note({.code = FindingCode::point_margins_left_out}));
  } else if (margins.stable) {
    confirm(motion, loop, analysis);
  }
  StableFor& holders = analysis.wall_stable_for.emplace();
  holders.nobody = margins.stable;
  if (!analysis.limits.user) return;
  holders.user = margins.stable;
  holders.nobody = point_wall_margins(motion, alone).stable;
  if (margins.stable && !holders.nobody) {
    analysis.remarks.push_back(
        warning({.code = FindingCode::unstable_with_nobody,
                 .evidence = {{"stiffness", wall.stiffness}},
                 .effect = {{"critical_stiffness", analysis.limits.nobody.critical_stiffness}}}));
  }
}

// A wall between the bounds is neither shown to be stable with everyone nor not to be.
void add_any_grasp(const TipMotion& motion, const DeviceParameters& alone, Analysis& analysis) {
  PointGraspLimit& bounds = analysis.point_wall->any_user.emplace(any_grasp_limit_of_point(motion, alone));
  const double nobody = analysis.limits.nobody.critical_stiffness;
  bounds.at_most = std::min(bounds.at_most, nobody);
  bounds.at_least = std::min(bounds.at_least, bounds.at_most);
  if (!motion.tips_beside.empty()) {
    const double at_pose = any_grasp_limit_of_point(motion, alone, GraspedPose::alone).at_least;
    analysis.remarks.push_back(singular_pose_remark(motion, std::min(at_pose, nobody), bounds.at_least));
  }
  analysis.remarks.push_back(note({.code = FindingCode::any_grasp_bounded}));
  if (!analysis.wall) return;
  StableFor& holders = *analysis.wall_stable_for;
  if (!holders.nobody || analysis.wall->stiffness > bounds.at_most) {
    holders.any_user = false;
  } else if (analysis.wall->stiffness < bounds.at_least) {
    holders.any_user = true;
  }
}

}  // namespace

Analysis point_wall_analysis(const Device& device, const AnalysisOptions& options) {
  Analysis analysis;
  analysis.remarks = implausible_numbers(device);
  const TipMotion motion = tip_motion_of(device).value();
  const DeviceParameters loop = loop_of(device);
  DeviceParameters alone = loop;
  alone.user = {};
  const PointWallLimit limit = point_wall_limit(motion, loop);
  const PointWallLimit nobody = device_has_user(device) ? point_wall_limit(motion, alone) : limit;
  analysis.trust = trust_of(device);
  analysis.trust.inherit(limit.trust);
  analysis.trust.inherit(nobody.trust);
  analysis.point_wall.emplace();
  if (analysis.trust.refused()) {
    analysis.critical.status = StiffnessStatus::refused;
    analysis.critical.stiffness = std::numeric_limits<double>::quiet_NaN();
    analysis.critical.trust = analysis.trust;
    return analysis;
  }
  analysis.critical.status = limit.status;
  analysis.critical.stiffness = limit.stiffness;
  analysis.critical.trust = analysis.trust;
  analysis.point_wall->frequency = limit.frequency;
  analysis.point_wall->direction = limit.direction;
  analysis.limits.nobody = holder_limit_of(nobody);
  if (device_has_user(device)) analysis.limits.user = holder_limit_of(limit);
  judge_point_wall(motion, loop, alone, analysis);
  if (options.any_user && device.degrees_of_freedom() <= most_bodies_for_absolute_stability) {
    add_any_grasp(motion, alone, analysis);
  } else if (options.any_user) {
    analysis.remarks.push_back(note({.code = FindingCode::any_grasp_not_known}));
  }
  judge_damping_of_wall(analysis);
  return analysis;
}

}  // namespace zwidth::internal
