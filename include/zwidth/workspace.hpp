#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/mechanism.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// Most poses times directions of a workspace.
inline constexpr std::size_t most_workspace_limits = 10'000'000;

/// Positions of one joint, evenly apart.
struct PoseAxis {
  std::string joint;                ///< of the mechanism's file
  double first = 0.0;               ///< m or rad
  double last = 0.0;                ///< m or rad
  std::size_t count = 1;            ///< with both ends; 1: `first` alone
  std::optional<Motion> unit = {};  ///< linear: m, rotary: rad; refused where the joint has the other motion
};

/// Where in the workspace, and in which directions, the limits are asked.
///
/// Of `grid`, `poses` and `points` one at most. None: a grid of the ranges that the file gives pose_joints(), of about 1000
/// poses, without those at which a joint that follows is beyond its own. Joints that are not given stay where the device's
/// pose has them.
struct WorkspaceOptions {
  std::vector<PoseAxis> grid = {};         ///< all combinations, the last axis fastest
  std::vector<JointPositions> poses = {};  ///< a list
  /// linear: m, rotary: rad; of joints of `poses`, refused where the joint has the other motion
  std::map<std::string, Motion> units_of_poses = {};
  std::vector<Eigen::Vector3d> points =
      {};  ///< m, world's frame: poses that bring the tip there, MechanismModel::reach()
  /// Of the wall, world's frame, of any length; empty: `directions`. Parallel ones are one wall, the first of them.
  std::vector<Eigen::Vector3d> normals = {};
  /// So many normals at each pose, spread over the directions in which the tip can move there (n and -n are one), from
  /// which the least and the greatest limit are refined; 0: 12 in a plane, 48 in space, 1 along a line.
  std::size_t directions = 0;
  std::optional<double> stiffness = {};  ///< N/m, of share_at_least; > 0
  bool any_user = true;                  ///< the limits over all passive grasps of the tip
  std::size_t threads = 0;               ///< 0: all cores. No result depends on it
  Progress progress = {};                ///< told how far the work is; ends it by throwing
};

/// Checks what the options say alone: one of grid, poses and points; counts, finite numbers, no joint twice, normals of
/// some length; stiffness; threads; at most most_workspace_limits poses times directions.
[[nodiscard]] std::optional<OptionProblem> find_problem(const WorkspaceOptions& options);

/// The same, and what depends on the device: that it is a mechanism, that its file has these joints, that joints of which
/// neither grid nor file says the range are given.
[[nodiscard]] std::optional<OptionProblem> find_problem(const WorkspaceOptions& options, const Device& device);

/// The limits at one pose along one normal.
struct DirectionLimits {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();   ///< of length 1
  StiffnessStatus status = StiffnessStatus::refused;  ///< with nobody holding
  double nobody = 0.0;                                ///< N/m; infinity: unbounded, 0: none stable, NaN: refused
  double nobody_frequency = 0.0;                      ///< rad/s, there; 0 unless finite
  std::optional<double> any_user = {};  ///< N/m, at most `nobody`, to 1e-4; absent where it is not asked for or known
  double any_user_frequency = 0.0;      ///< rad/s, of the worst user; 0 where there is none
};

/// A direction that has no limit, and why: the tip cannot move along it, motors cannot push it.
struct RefusedDirection {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of length 1
  Problem problem = {};                              ///< what device_along() says
};

/// One pose.
struct WorkspacePose {
  JointPositions pose = {};                       ///< that leads there, by joints that were given: mechanism.pose
  std::vector<double> joints = {};                ///< of MechanismModel::joints(), m or rad; empty where not reached
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< m, world's frame
  std::optional<std::size_t> point = {};          ///< which of WorkspaceOptions::points it reaches
  std::optional<Problem> problem = {};            ///< why nothing is known here: a loop stays open, a singular pose
  std::vector<DirectionLimits> directions = {};   ///< those tried, in their order, without refused ones
  std::vector<RefusedDirection> refused = {};     ///< the others
  /// Refined between the directions tried; the normals alone where those were given. Absent where there is none.
  std::optional<DirectionLimits> least = {};           ///< with nobody
  std::optional<DirectionLimits> greatest = {};        ///< with nobody
  std::optional<DirectionLimits> least_any_user = {};  ///< with any passive user; absent where one of them is not known
};

/// A limit somewhere in the workspace, computed once more as `analyze()` does for the device of that pose and normal.
struct WorkspaceLimit {
  double stiffness = 0.0;                     ///< N/m; 0: no wall is stable, infinity: every one is
  double frequency = 0.0;                     ///< rad/s, of the oscillation or of the worst user; 0 where there is none
  std::optional<Oscillator> limited_by = {};  ///< what oscillates; of any user where nobody sets his limit
  std::size_t pose = 0;                       ///< of Workspace::poses
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of length 1
};

/// A quantile over poses times directions tried, X_(ceil(N p)); infinity: unbounded there.
struct WorkspaceQuantile {
  double probability = 0.0;  ///< share below
  double nobody = 0.0;       ///< N/m
  std::optional<double> any_user =
      {};  ///< N/m; a limit that is not known counts as 0; absent where it is known nowhere
};

/// How much of poses times directions tried has a limit of at least a stiffness.
struct WorkspaceShare {
  double stiffness = 0.0;               ///< N/m
  double nobody = 0.0;                  ///< 0..1
  std::optional<double> any_user = {};  ///< 0..1, likewise
};

/// A point that the tip does not reach.
struct UnreachedPoint {
  std::size_t point = 0;                         ///< of WorkspaceOptions::points
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< m, world's frame
  double short_of = 0.0;                         ///< m, how close it comes from the device's pose on
};

/// The limits over a workspace. Where it is refused (trust), there is no limit in it.
struct Workspace {
  std::vector<MechanismJoint> joints;    ///< of the mechanism
  std::vector<std::string> pose_joints;  ///< that were varied, or give the poses of points
  std::size_t tip_directions = 0;        ///< in how many independent directions the tip moves, most of all poses
  std::optional<WorkspaceLimit> least;   ///< with nobody holding; absent where no pose has a limit
  std::optional<WorkspaceLimit>
      least_any_user;                        ///< of the known ones with any passive user; absent unless there are some
  std::vector<WorkspaceQuantile> quantiles;  ///< at 0, 5, 25, 50, 75, 95 and 100 %; empty where nothing is known
  std::optional<WorkspaceShare> share_at_least;  ///< of options.stiffness
  std::vector<WorkspacePose> poses;              ///< in the order of the grid, the list, or the points that are reached
  std::vector<UnreachedPoint> unreached;         ///< points
  std::uint64_t directions = 0;                  ///< poses times directions that have a limit
  std::uint64_t refused_directions = 0;          ///< that have none, those of refused poses too where they are known
  std::uint64_t refused_poses = 0;               ///< without any
  Trust
      trust;  ///< the device's, that the least is confirmed, and that no limit with any user is unknown beside known ones
  std::vector<Remark> remarks;  ///< what was left out, and why
};

/// The stiffest wall at every pose and in every direction of a mechanism: the entry point.
///
/// Nobody holds, or any passive user grasps the tip in every direction: limits_along(). The device's pose is where joints
/// that are not varied stay, its normal and its user are not asked, its wall's damper stays closed. A pose that is singular
/// or does not close its loops is an answer with a problem. The least of all is computed once more by critical_stiffness()
/// and any_grasp_limit() of the device there: what contradicts is doubtful.
/// Filters of the wall are answered one direction at a time; with a damper in a loop of its own the limit for any user is not
/// known, and absent. Throws Error (invalid_argument) where find_problem(options, device) finds one, and whatever
/// options.progress throws. Source: docs/theory.md, "Several axes".
[[nodiscard]] Workspace workspace(const Device& device, const WorkspaceOptions& options = {});

/// The device of a mechanism at another pose, its wall along a normal: what a device file of the worst pose holds.
///
/// Joints that are not given stay where the device's pose has them. Throws Error (invalid_argument) as
/// device_of_mechanism(), and for a device of no mechanism.
[[nodiscard]] Device device_at(const Device& device, const JointPositions& pose, const Eigen::Vector3d& normal);

}  // namespace zwidth
