#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "counted.hpp"
#include "workspace/direction_spread.hpp"
#include "workspace/pose_list.hpp"
#include "zwidth/batch/batch_stiffness.hpp"
#include "zwidth/workspace.hpp"

namespace zwidth {
namespace internal {
namespace {

constexpr double usual_poses = 1000.0;
constexpr std::size_t most_directions = 100'000;

OptionProblem not_finite(std::string member, double value) {
  return option_problem(std::move(member), {.code = ProblemCode::not_finite, .evidence = {{"value", value}}});
}

std::optional<OptionProblem> problem_of_grid(const WorkspaceOptions& options) {
  std::set<std::string> joints;
  for (std::size_t i = 0; i < options.grid.size(); ++i) {
    const PoseAxis& axis = options.grid[i];
    const std::string member = fmt::format("grid.{}", i);
    if (!std::isfinite(axis.first)) return not_finite(member + ".first", axis.first);
    if (!std::isfinite(axis.last)) return not_finite(member + ".last", axis.last);
    if (axis.count == 0 || axis.count > most_workspace_limits) {
      return option_problem(
          member + ".count",
          {.code = ProblemCode::count_out_of_range,
           .evidence = {counted("value", axis.count), {"least", 1.0}, counted("most", most_workspace_limits)}});
    }
    if (!joints.insert(axis.joint).second) {
      return option_problem(member + ".joint",
                            {.code = ProblemCode::joint_given_twice, .subjects = {{"name", axis.joint}}});
    }
  }
  return std::nullopt;
}

std::optional<OptionProblem> problem_of_lists(const WorkspaceOptions& options) {
  for (std::size_t i = 0; i < options.poses.size(); ++i) {
    for (const auto& [joint, position] : options.poses[i]) {
      if (!std::isfinite(position)) return not_finite(fmt::format("poses.{}.{}", i, joint), position);
    }
  }
  for (std::size_t i = 0; i < options.points.size(); ++i) {
    for (const double each : options.points[i]) {
      if (!std::isfinite(each)) return not_finite(fmt::format("points.{}", i), each);
    }
  }
  for (std::size_t i = 0; i < options.normals.size(); ++i) {
    const Eigen::Vector3d& normal = options.normals[i];
    if (normal.allFinite() && normal.stableNorm() > 0.0 && std::isfinite(normal.stableNorm())) continue;
    return option_problem(
        fmt::format("normals.{}", i),
        {.code = ProblemCode::no_direction, .evidence = {{"x", normal.x()}, {"y", normal.y()}, {"z", normal.z()}}});
  }
  return std::nullopt;
}

std::optional<OptionProblem> problem_of_ways(const WorkspaceOptions& options) {
  std::vector<const char*> given;
  if (!options.grid.empty()) given.push_back("grid");
  if (!options.poses.empty()) given.push_back("poses");
  if (!options.points.empty()) given.push_back("points");
  if (given.size() < 2) return std::nullopt;
  return option_problem(
      given[1], {.code = ProblemCode::poses_given_twice, .subjects = {{"first", given[0]}, {"second", given[1]}}});
}

std::optional<OptionProblem> too_many(const char* member, std::size_t poses, std::size_t directions) {
  if (poses <= most_workspace_limits / std::max<std::size_t>(directions, 1)) return std::nullopt;
  return option_problem(member, {.code = ProblemCode::too_many_workspace_limits,
                                 .evidence = {counted("poses", poses), counted("directions", directions),
                                              counted("most", most_workspace_limits)}});
}

// Of the largest spread where none is given.
std::size_t directions_of(const WorkspaceOptions& options) {
  if (!options.normals.empty()) return options.normals.size();
  return options.directions > 0 ? options.directions : usual_directions(3);
}

std::optional<OptionProblem> problem_of_joint(const MechanismModel& mechanism, std::string member,
                                              const std::string& joint, std::optional<Motion> unit) {
  const auto& joints = mechanism.joints();
  const auto found = std::ranges::find(joints, joint, &MechanismJoint::name);
  if (found == joints.end()) {
    std::string names;
    for (const MechanismJoint& each : joints) names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", each.name);
    return option_problem(std::move(member), {.code = ProblemCode::no_such_part,
                                              .subjects = {{"kind", "joint"}, {"name", joint}, {"names", names}}});
  }
  if (!unit || *unit == found->motion) return std::nullopt;
  std::vector<Subject> subjects{{"name", joint}};
  if (found->motion == Motion::linear) subjects.push_back({"slides", "slides"});
  return option_problem(std::move(member), {.code = ProblemCode::unit_of_other_joint, .subjects = std::move(subjects)});
}

}  // namespace

std::vector<PoseAxis> grid_of(const WorkspaceOptions& options, const MechanismModel& mechanism) {
  if (!options.grid.empty() || !options.poses.empty() || !options.points.empty()) return options.grid;
  const std::vector<std::string> joints = mechanism.pose_joints();
  const double each =
      std::round(std::pow(usual_poses, 1.0 / std::max<double>(static_cast<double>(joints.size()), 1.0)));
  const auto count = static_cast<std::size_t>(std::max(each, 2.0));
  std::vector<PoseAxis> grid;
  for (const MechanismJoint& joint : mechanism.joints()) {
    if (joint.is_of_pose && joint.range) grid.push_back({joint.name, joint.range->least, joint.range->greatest, count});
  }
  return grid;
}

std::size_t poses_of(const std::vector<PoseAxis>& grid) {
  std::size_t poses = 1;
  for (const PoseAxis& axis : grid) {
    if (axis.count > most_workspace_limits / poses) return most_workspace_limits + 1;
    poses *= axis.count;
  }
  return poses;
}

JointPositions pose_of(const std::vector<PoseAxis>& grid, std::size_t number) {
  JointPositions pose;
  for (std::size_t i = grid.size(); i-- > 0;) {
    const auto& [joint, first, last, count, unit] = grid[i];
    const std::size_t step = number % count;
    number /= count;
    const double share = count > 1 ? static_cast<double>(step) / static_cast<double>(count - 1) : 0.0;
    pose[joint] = step + 1 == count && count > 1 ? last : first + share * (last - first);
  }
  return pose;
}

}  // namespace internal

std::optional<OptionProblem> find_problem(const WorkspaceOptions& options) {
  using namespace internal;
  if (auto problem = problem_of_ways(options)) return problem;
  if (auto problem = problem_of_grid(options)) return problem;
  if (auto problem = problem_of_lists(options)) return problem;
  if (options.directions > most_directions) {
    return option_problem(
        "directions",
        {.code = ProblemCode::count_out_of_range_or_zero,
         .evidence = {counted("value", options.directions), {"least", 1.0}, counted("most", most_directions)}});
  }
  const std::size_t directions = directions_of(options);
  if (auto problem = too_many("grid", poses_of(options.grid), directions)) return problem;
  if (auto problem = too_many("poses", options.poses.size(), directions)) return problem;
  if (auto problem = too_many("points", options.points.size(), directions)) return problem;
  if (options.stiffness && !(std::isfinite(*options.stiffness) && *options.stiffness > 0.0)) {
    return option_problem("stiffness", {.code = ProblemCode::not_finite_and_positive,
                                        .evidence = {{"value", *options.stiffness, "N/m"}}});
  }
  if (options.threads > most_batch_threads) {
    return option_problem("threads",
                          {.code = ProblemCode::too_many_threads,
                           .evidence = {counted("value", options.threads), counted("most", most_batch_threads)}});
  }
  return std::nullopt;
}

std::optional<OptionProblem> find_problem(const WorkspaceOptions& options, const Device& device) {
  using namespace internal;
  if (auto problem = find_problem(options)) return problem;
  if (!device.parameters().mechanism) return option_problem("", {.code = ProblemCode::not_a_mechanism});
  const MechanismModel mechanism(device.parameters().mechanism->mechanism);
  for (std::size_t i = 0; i < options.grid.size(); ++i) {
    const PoseAxis& axis = options.grid[i];
    if (auto problem = problem_of_joint(mechanism, fmt::format("grid.{}.joint", i), axis.joint, axis.unit))
      return problem;
  }
  for (std::size_t i = 0; i < options.poses.size(); ++i) {
    for (const auto& [joint, position] : options.poses[i]) {
      const auto unit = options.units_of_poses.find(joint);
      if (auto problem =
              problem_of_joint(mechanism, fmt::format("poses.{}", i), joint,
                               unit == options.units_of_poses.end() ? std::nullopt : std::optional(unit->second))) {
        return problem;
      }
    }
  }
  if (!options.grid.empty() || !options.poses.empty() || !options.points.empty()) return std::nullopt;
  for (const MechanismJoint& joint : mechanism.joints()) {
    if (!joint.is_of_pose || joint.range) continue;
    return option_problem("grid", {.code = ProblemCode::joint_without_range, .subjects = {{"name", joint.name}}});
  }
  return std::nullopt;
}

}  // namespace zwidth
