#include "zwidth/workspace.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "counted.hpp"
#include "mechanism/tip_reach.hpp"
#include "model/implausible_numbers.hpp"
#include "staged_progress.hpp"
#include "thread_arena.hpp"
#include "workspace/direction_spread.hpp"
#include "workspace/pose_limits.hpp"
#include "workspace/pose_list.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
namespace {

using internal::counted;

constexpr double confirmed_within = 1e-3;  // relative, of the least limit by the other route
constexpr double in_the_plane = 1e-6;      // what of a direction may stand out of it
constexpr std::array quantile_probabilities{0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0};

class WorkspaceSearch {
 public:
  WorkspaceSearch(const Device& device, const WorkspaceOptions& options)
      : parameters_(device.parameters()),
        options_(options),
        mechanism_(parameters_.mechanism->mechanism),
        arena_(options.threads) {
    result_.joints = mechanism_.joints();
    result_.pose_joints = mechanism_.pose_joints();
    result_.trust = trust_of(device);
    result_.remarks = internal::implausible_numbers(device);
    if (parameters_.mechanism->is_point)
      result_.remarks.push_back(note({.code = FindingCode::workspace_along_normals}));
    if (device_has_user(device)) result_.remarks.push_back(note({.code = FindingCode::workspace_without_user}));
  }

  Workspace run() {
    if (result_.trust.refused()) return std::move(result_);
    list_poses();
    internal::SharedProgress progress(options_.progress, result_.poses.size());
    arena_.execute([&] {
      tbb::parallel_for(std::size_t{0}, result_.poses.size(), [&](std::size_t i) {
        answer(i);
        progress.add();
      });
    });
    refuse_lost_directions();
    leave_out_unreached();
    count();
    add_quantiles();
    add_least();
    add_remarks();
    return std::move(result_);
  }

 private:
  void list_poses() {
    if (!options_.poses.empty()) {
      for (const JointPositions& each : options_.poses) result_.poses.push_back({.pose = each});
      std::erase_if(result_.pose_joints, [&](const std::string& joint) { return !is_listed(joint); });
      for (const MechanismJoint& each : result_.joints) {
        if (is_listed(each.name) && !each.is_of_pose) result_.pose_joints.push_back(each.name);
      }
    } else if (!options_.points.empty()) {
      for (std::size_t i = 0; i < options_.points.size(); ++i) result_.poses.push_back({.pose = {}, .point = i});
    } else {
      const std::vector<PoseAxis> grid = internal::grid_of(options_, mechanism_);
      result_.pose_joints.clear();
      for (const PoseAxis& axis : grid) result_.pose_joints.push_back(axis.joint);
      result_.poses.resize(internal::poses_of(grid));
      for (std::size_t i = 0; i < result_.poses.size(); ++i) result_.poses[i].pose = internal::pose_of(grid, i);
    }
    state_.resize(result_.poses.size());
  }

  [[nodiscard]] bool is_listed(const std::string& joint) const {
    return std::ranges::any_of(options_.poses, [&](const JointPositions& pose) { return pose.contains(joint); });
  }

  // One pose; of a point first how the tip comes there.
  void answer(std::size_t number) {
    WorkspacePose& pose = result_.poses[number];
    try {
      if (pose.point) {
        MechanismModel::Reached reached = mechanism_.reach(options_.points[*pose.point]);
        pose.pose = std::move(reached.pose);
        if (!reached.reached) {
          state_[number].short_of = reached.short_of;
          return;
        }
      }
      const MechanismAtPose at = mechanism_.at(pose.pose);
      state_[number].is_beyond_range = !internal::is_within_ranges(result_.joints, at.joints);
      if (state_[number].is_beyond_range && is_of_ranges()) return;
      state_[number].moved = internal::moved_directions(at.tip).cols();
      state_[number].is_singular = !at.tips_beside.empty();
      internal::add_limits(at, parameters_, options_, pose);
    } catch (const Error& error) {
      pose.problem = internal::problem_of(error);
    }
  }

  [[nodiscard]] bool is_of_ranges() const {
    return options_.grid.empty() && options_.poses.empty() && options_.points.empty();
  }

  // At a singular pose the tip cannot move in a direction in which it moves elsewhere.
  void refuse_lost_directions() {
    const auto most = std::ranges::max_element(state_, {}, &PoseState::moved);
    if (most == state_.end() || most->moved == 0) return;
    result_.tip_directions = static_cast<std::size_t>(most->moved);
    if (!options_.normals.empty()) return;
    const Eigen::MatrixXd all = moved_at(static_cast<std::size_t>(most - state_.begin()));
    for (std::size_t i = 0; i < state_.size(); ++i) {
      if (state_[i].moved == 0 || state_[i].moved == most->moved) continue;
      const Eigen::MatrixXd left = moved_at(i);
      if ((left - all * (all.transpose() * left)).norm() > in_the_plane) continue;  // no plane of all poses
      for (const Eigen::Vector3d& normal : internal::directions_beside(all, left)) {
        result_.poses[i].refused.push_back({normal, internal::tip_stays_along(normal)});
      }
    }
  }

  [[nodiscard]] Eigen::MatrixXd moved_at(std::size_t number) const {
    return internal::moved_directions(mechanism_.at(result_.poses[number].pose).tip);
  }

  void leave_out_unreached() {
    std::vector<WorkspacePose> reached;
    for (std::size_t i = 0; i < result_.poses.size(); ++i) {
      WorkspacePose& pose = result_.poses[i];
      if (state_[i].short_of) {
        result_.unreached.push_back({*pose.point, options_.points[*pose.point], *state_[i].short_of});
      } else if (!(state_[i].is_beyond_range && is_of_ranges())) {
        reached.push_back(std::move(pose));
      }
    }
    result_.poses = std::move(reached);
  }

  void count() {
    for (const WorkspacePose& pose : result_.poses) {
      if (pose.directions.empty()) ++result_.refused_poses;
      result_.refused_directions += pose.refused.size();
      for (const DirectionLimits& each : pose.directions) {
        if (each.status == StiffnessStatus::refused) {
          ++result_.refused_directions;
          continue;
        }
        ++result_.directions;
        nobody_.push_back(each.nobody);
        any_user_.push_back(each.any_user.value_or(0.0));
        if (!each.any_user) ++unknown_any_user_;
      }
    }
    if (unknown_any_user_ == any_user_.size()) any_user_.clear();
    std::ranges::sort(nobody_);
    std::ranges::sort(any_user_);
  }

  static double quantile(const std::vector<double>& sorted, double probability) {
    const double place = std::ceil(probability * static_cast<double>(sorted.size()));
    return sorted[static_cast<std::size_t>(std::max(place, 1.0)) - 1];
  }

  static double share(const std::vector<double>& sorted, double stiffness) {
    const auto below = std::ranges::lower_bound(sorted, stiffness) - sorted.begin();
    return 1.0 - static_cast<double>(below) / static_cast<double>(sorted.size());
  }

  void add_quantiles() {
    if (nobody_.empty()) return;
    for (const double probability : quantile_probabilities) {
      WorkspaceQuantile each{.probability = probability, .nobody = quantile(nobody_, probability)};
      if (!any_user_.empty()) each.any_user = quantile(any_user_, probability);
      result_.quantiles.push_back(each);
    }
    if (!options_.stiffness) return;
    WorkspaceShare reached{.stiffness = *options_.stiffness, .nobody = share(nobody_, *options_.stiffness)};
    if (!any_user_.empty()) reached.any_user = share(any_user_, *options_.stiffness);
    result_.share_at_least = reached;
  }

  // The pose at which `limits` have the least value.
  template <typename Value>
  [[nodiscard]] std::optional<std::size_t> least_pose(std::optional<DirectionLimits> WorkspacePose::*limits,
                                                      const Value& value) const {
    std::optional<std::size_t> least;
    for (std::size_t i = 0; i < result_.poses.size(); ++i) {
      const std::optional<DirectionLimits>& each = result_.poses[i].*limits;
      if (each && (!least || value(*each) < value(*(result_.poses[*least].*limits)))) least = i;
    }
    return least;
  }

  void add_least() {
    const auto with_nobody = [](const DirectionLimits& each) { return each.nobody; };
    const auto with_any_user = [](const DirectionLimits& each) { return *each.any_user; };
    if (const auto pose = least_pose(&WorkspacePose::least, with_nobody)) {
      const DirectionLimits& quick = *result_.poses[*pose].least;
      result_.least = confirmed({quick.nobody, quick.nobody_frequency, {}, *pose, quick.normal}, false);
    }
    if (const auto pose = least_pose(&WorkspacePose::least_any_user, with_any_user)) {
      const DirectionLimits& quick = *result_.poses[*pose].least_any_user;
      result_.least_any_user = confirmed({*quick.any_user, quick.any_user_frequency, {}, *pose, quick.normal}, true);
    }
  }

  // Once more, as the device of that pose and normal is analysed.
  WorkspaceLimit confirmed(WorkspaceLimit limit, bool with_any_user) {
    try {
      const MechanismAtPose at = mechanism_.at(result_.poses[limit.pose].pose);
      const internal::ExactLimits exact = internal::exact_limits(at, parameters_, limit.normal, with_any_user);
      trust_no_more_than(exact.nobody.trust);
      if (exact.nobody.status == StiffnessStatus::refused) return limit;
      if (exact.any_user) trust_no_more_than(exact.any_user->trust);
      if (with_any_user && !exact.any_user) {
        result_.trust.doubt({.code = FindingCode::any_grasp_not_known});
        return limit;
      }
      const double stiffness = with_any_user ? exact.any_user->stiffness : exact.nobody.stiffness;
      const bool is_same =
          stiffness == limit.stiffness || std::abs(stiffness - limit.stiffness) <= confirmed_within * stiffness;
      if (!is_same) {
        result_.trust.doubt({.code = FindingCode::workspace_least_contradicts,
                             .evidence = {{"stiffness", stiffness, "N/m"}, {"other", limit.stiffness, "N/m"}}});
      }
      limit.stiffness = stiffness;
      if (with_any_user) limit.frequency = exact.any_user->frequency;
      if (exact.nobody.limit && (!with_any_user || exact.any_user->needs_no_user)) {
        limit.frequency = exact.nobody.limit->frequency;
        limit.limited_by = exact.nobody.limit->limited_by;
      }
    } catch (const Error& error) {
      result_.trust.doubt({.code = FindingCode::not_converged, .subjects = {{"reason", error.what()}}});
    }
    return limit;
  }

  // Of the least alone: what refuses its number there leaves that of the first computation doubtful.
  void trust_no_more_than(const Trust& trust) {
    if (!trust.refused()) return result_.trust.inherit(trust);
    for (const Finding& each : trust.findings) result_.trust.doubt(each);
  }

  void add_remarks() {
    if (result_.refused_poses > 0) {
      const Finding refused{.code = FindingCode::workspace_poses_refused,
                            .evidence = {counted("count", result_.refused_poses), counted("of", result_.poses.size())}};
      if (nobody_.empty()) {
        result_.trust.refuse(refused);
      } else {
        result_.remarks.push_back(warning(refused));
      }
    }
    const auto singular = static_cast<std::size_t>(std::ranges::count_if(state_, &PoseState::is_singular));
    if (singular > 0 && !nobody_.empty()) {
      result_.remarks.push_back(
          warning({.code = FindingCode::workspace_poses_singular,
                   .evidence = {counted("count", singular), counted("of", result_.poses.size())}}));
    }
    const auto beyond = static_cast<std::size_t>(std::ranges::count_if(state_, &PoseState::is_beyond_range));
    if (beyond > 0 && !is_of_ranges()) {
      result_.remarks.push_back(warning({.code = FindingCode::workspace_beyond_ranges,
                                         .evidence = {counted("count", beyond), counted("of", state_.size())}}));
    }
    if (result_.refused_directions > 0) {
      result_.remarks.push_back(
          warning({.code = FindingCode::workspace_directions_refused,
                   .evidence = {counted("count", result_.refused_directions),
                                counted("of", result_.refused_directions + result_.directions)}}));
    }
    if (!result_.unreached.empty()) {
      const Finding unreached{
          .code = FindingCode::workspace_points_not_reached,
          .evidence = {counted("count", result_.unreached.size()), counted("of", options_.points.size())}};
      if (result_.poses.empty()) {
        result_.trust.refuse(unreached);
      } else {
        result_.remarks.push_back(warning(unreached));
      }
    }
    if (nobody_.empty()) return;
    if (options_.any_user && any_user_.empty()) {
      result_.remarks.push_back(note({.code = FindingCode::any_grasp_not_known}));
    } else if (options_.any_user && unknown_any_user_ > 0) {
      result_.trust.doubt({.code = FindingCode::any_grasp_not_known_somewhere,
                           .evidence = {counted("count", unknown_any_user_), counted("of", any_user_.size())}});
    }
    if (options_.any_user && !any_user_.empty() && result_.tip_directions > 1) {
      result_.remarks.push_back(note({.code = FindingCode::any_grasp_scanned}));
    }
    Finding tried{.code = FindingCode::workspace_of_tried_poses,
                  .evidence = {counted("poses", result_.poses.size()), counted("directions", result_.directions)}};
    if (options_.normals.empty() && result_.tip_directions > 1) tried.subjects = {{"refined", "refined"}};
    result_.remarks.push_back(note(std::move(tried)));
  }

  // Of a pose, until all are known.
  struct PoseState {
    Eigen::Index moved = 0;               // in how many directions the tip can move
    bool is_singular = false;             // in fewer than beside
    std::optional<double> short_of = {};  // m, of a point that is not reached
    bool is_beyond_range = false;         // of some joint: of a grid of ranges, of one that follows
  };

  const DeviceParameters& parameters_;
  const WorkspaceOptions& options_;
  MechanismModel mechanism_;
  internal::ThreadArena arena_;
  std::vector<PoseState> state_;
  std::vector<double> nobody_;    // limits of all directions, rising
  std::vector<double> any_user_;  // the same; 0 where it is not known; empty where it is known nowhere
  std::size_t unknown_any_user_ = 0;
  Workspace result_;
};

}  // namespace

Workspace workspace(const Device& device, const WorkspaceOptions& options) {
  require_valid(find_problem(options, device));
  WorkspaceOptions once = options;
  once.normals = internal::distinct_walls(options.normals);
  return WorkspaceSearch(device, once).run();
}

Device device_at(const Device& device, const JointPositions& pose, const Eigen::Vector3d& normal) {
  if (!device.parameters().mechanism) throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::not_a_mechanism});
  DeviceParameters parameters = device.parameters();
  parameters.coordinates.reset();
  MechanismDirection& along = *parameters.mechanism;
  for (const auto& [joint, position] : pose) along.mechanism.pose[joint] = position;
  along.normal = {normal.x(), normal.y(), normal.z()};
  along.is_point = false;
  return device_of_mechanism(std::move(parameters));
}

}  // namespace zwidth
