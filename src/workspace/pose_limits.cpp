#include "workspace/pose_limits.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "stability/tip/limits_at_pose.hpp"
#include "stability/users/any_user_limit.hpp"
#include "workspace/direction_spread.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::internal {
namespace {

// Filters are of one direction alone.
bool has_plain_wall(const DeviceParameters& parameters) {
  return parameters.wall.filters.empty() && !runs_damper_apart(parameters);
}

// The limits along any normal at a pose: by what is of the pose, once, where that is known, else one by one.
class AnyDirection {
 public:
  AnyDirection(const MechanismAtPose& at, const DeviceParameters& parameters, bool any_user)
      : at_(at), parameters_(parameters), any_user_(any_user) {
    any_user_ = any_user_ && !runs_damper_apart(parameters) &&
                static_cast<std::size_t>(at.mass.rows()) <= most_bodies_for_absolute_stability;
    // A tip that moves along one direction alone is one axis, of which more is known.
    const bool is_one_axis = moved_directions(at.tip).cols() == 1 && at.tips_beside.empty();
    if (!has_plain_wall(parameters) || is_one_axis) return;
    DeviceParameters loop = parameters;
    loop.loop.damper.reset();
    loop.user = {};
    try {
      shared_ = std::make_unique<const LimitsAtPose>(tip_motion(at), loop, NormalLimitsOptions{.any_grasp = any_user_});
    } catch (const Error&) {
      shared_.reset();  // motors do not push the tip along some direction
    }
  }

  // Nothing where there are limits.
  [[nodiscard]] std::optional<Problem> refusal(const Eigen::Vector3d& normal) const {
    if (!tip_moves_along(at_.tip, normal)) return tip_stays_along(normal);
    if (shared_) return std::nullopt;
    try {
      static_cast<void>(device_along(at_, normal, alone_along(parameters_, normal)));
    } catch (const Error& error) {
      return problem_of(error);
    }
    return std::nullopt;
  }

  [[nodiscard]] DirectionLimits along(const Eigen::Vector3d& normal, bool with_any_user) const {
    DirectionLimits limits{.normal = normal};
    if (!shared_) {
      add_exact(limits, with_any_user && any_user_);
      return limits;
    }
    const NormalLimits nobody = shared_->nobody_along(normal);
    limits.status = nobody.status;
    limits.nobody = nobody.stiffness;
    limits.nobody_frequency = nobody.frequency;
    if (!with_any_user || !any_user_ || nobody.status == StiffnessStatus::refused) return limits;
    limits.any_user = nobody.stiffness;
    limits.any_user_frequency = nobody.frequency;
    if (nobody.stiffness == 0.0) return limits;
    const GraspLimit grasp = shared_->any_grasp_along(normal);
    if (std::isnan(grasp.stiffness)) {
      limits.any_user.reset();
      limits.any_user_frequency = 0.0;
      return limits;
    }
    if (nobody.stiffness <= grasp.stiffness) return limits;
    limits.any_user = grasp.stiffness;
    limits.any_user_frequency = grasp.frequency;
    return limits;
  }

 private:
  void add_exact(DirectionLimits& limits, bool with_any_user) const {
    const ExactLimits exact = exact_limits(at_, parameters_, limits.normal, with_any_user);
    limits.status = exact.nobody.status;
    limits.nobody = exact.nobody.stiffness;
    if (exact.nobody.limit) limits.nobody_frequency = exact.nobody.limit->frequency;
    if (!exact.any_user) return;
    limits.any_user = exact.any_user->stiffness;
    limits.any_user_frequency = exact.any_user->frequency;
  }

  const MechanismAtPose& at_;
  const DeviceParameters& parameters_;
  bool any_user_;
  std::unique_ptr<const LimitsAtPose> shared_;
};

constexpr double not_known = -1.0;  // below every limit

double nobody_of(const DirectionLimits& limits) {
  return limits.status == StiffnessStatus::refused ? std::numeric_limits<double>::infinity() : limits.nobody;
}

struct Refinement {
  bool with_any_user = false;
  bool may_jump = false;  // as the limit with nobody holding over directions
};

// The direction in which `value` is least, refined from those tried.
template <typename Value>
DirectionLimits refined(const std::vector<DirectionLimits>& tried, const Eigen::MatrixXd& moved,
                        const AnyDirection& any_direction, Refinement how, const Value& value) {
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> values;
  for (const DirectionLimits& each : tried) {
    normals.push_back(each.normal);
    values.push_back(value(each));
  }
  const LeastDirection least = least_direction(
      normals, values, moved,
      [&](const Eigen::Vector3d& normal) { return value(any_direction.along(normal, how.with_any_user)); },
      how.may_jump);
  return any_direction.along(least.normal, true);
}

template <typename Value>
DirectionLimits least_of(const std::vector<DirectionLimits>& tried, const Value& value) {
  return *std::ranges::min_element(tried, {}, value);
}

void add_extremes(const AnyDirection& any_direction, const Eigen::MatrixXd& moved, bool is_spread,
                  WorkspacePose& pose) {
  std::vector<DirectionLimits> known;
  for (const DirectionLimits& each : pose.directions) {
    if (each.status != StiffnessStatus::refused) known.push_back(each);
  }
  if (known.empty()) return;
  const auto greatest = [](const DirectionLimits& each) {
    return each.status == StiffnessStatus::refused ? std::numeric_limits<double>::infinity() : -each.nobody;
  };
  // What is not known may be the least of all.
  const auto any_user = [](const DirectionLimits& each) {
    return each.status == StiffnessStatus::refused ? std::numeric_limits<double>::infinity()
                                                   : each.any_user.value_or(not_known);
  };
  const bool has_any_user = std::ranges::all_of(known, [](const auto& each) { return each.any_user.has_value(); });
  if (!is_spread) {
    pose.least = least_of(known, nobody_of);
    pose.greatest = least_of(known, greatest);
    if (has_any_user) pose.least_any_user = least_of(known, any_user);
    return;
  }
  pose.least = refined(known, moved, any_direction, {.may_jump = true}, nobody_of);
  pose.greatest = refined(known, moved, any_direction, {}, greatest);
  if (!has_any_user) return;
  const DirectionLimits least = refined(known, moved, any_direction, {.with_any_user = true}, any_user);
  if (least.any_user) pose.least_any_user = least;
}

}  // namespace

Problem problem_of(const Error& error) {
  if (!error.problems().empty() && error.problems().front().problem) return *error.problems().front().problem;
  return {.code = ProblemCode::of_the_device, .subjects = {{"what", error.what()}}};
}

Problem tip_stays_along(const Eigen::Vector3d& normal) {
  return {.code = ProblemCode::tip_does_not_move,
          .evidence = {{"x", normal.x()}, {"y", normal.y()}, {"z", normal.z()}}};
}

DeviceParameters alone_along(DeviceParameters parameters, const Eigen::Vector3d& normal) {
  parameters.user = {};
  parameters.mechanism->normal = {normal.x(), normal.y(), normal.z()};
  parameters.mechanism->is_point = false;
  return parameters;
}

ExactLimits exact_limits(const MechanismAtPose& at, const DeviceParameters& parameters, const Eigen::Vector3d& normal,
                         bool with_any_user) {
  const Device device = device_along(at, normal, alone_along(parameters, normal));
  ExactLimits limits{critical_stiffness(device), {}};
  if (!with_any_user || limits.nobody.status == StiffnessStatus::refused) return limits;
  if (device.degrees_of_freedom() <= most_bodies_for_absolute_stability) limits.any_user = any_user_limit(device);
  if (limits.any_user && std::isnan(limits.any_user->stiffness)) limits.any_user.reset();
  return limits;
}

void add_limits(const MechanismAtPose& at, const DeviceParameters& parameters, const WorkspaceOptions& options,
                WorkspacePose& pose) {
  pose.joints.assign(at.joints.begin(), at.joints.end());
  pose.tip = at.tip_position;
  const Eigen::MatrixXd moved = moved_directions(at.tip);
  if (moved.cols() == 0) {
    pose.problem = Problem{.code = ProblemCode::tip_stands_still};
    return;
  }
  const bool is_spread = options.normals.empty();
  const std::size_t count = options.directions > 0 ? options.directions : usual_directions(moved.cols());
  const AnyDirection any_direction(at, parameters, options.any_user);
  for (const Eigen::Vector3d& each : is_spread ? spread_directions(moved, count) : options.normals) {
    const Eigen::Vector3d normal = each.normalized();
    if (std::optional<Problem> problem = any_direction.refusal(normal)) {
      pose.refused.push_back({normal, *std::move(problem)});
    } else {
      pose.directions.push_back(any_direction.along(normal, true));
    }
  }
  if (pose.directions.empty()) pose.problem = pose.refused.front().problem;
  add_extremes(any_direction, moved, is_spread, pose);
}

}  // namespace zwidth::internal
