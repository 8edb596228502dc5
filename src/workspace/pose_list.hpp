#pragma once

// Which poses a workspace is asked at.

#include <cstddef>
#include <vector>

#include "zwidth/mechanism.hpp"
#include "zwidth/workspace.hpp"

namespace zwidth::internal {

// The grid that is asked, or that of the ranges of pose_joints() where neither poses nor points are.
[[nodiscard]] std::vector<PoseAxis> grid_of(const WorkspaceOptions& options, const MechanismModel& mechanism);

// How many poses a grid has; more than most_workspace_limits count as that.
[[nodiscard]] std::size_t poses_of(const std::vector<PoseAxis>& grid);

// The pose of that number, the last axis fastest.
[[nodiscard]] JointPositions pose_of(const std::vector<PoseAxis>& grid, std::size_t number);

}  // namespace zwidth::internal
