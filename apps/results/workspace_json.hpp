#pragma once

#include <string>
#include <vector>

#include "results/json.hpp"
#include "zwidth/workspace.hpp"

namespace zwidth::results {

/// Whether each pose holds its limits in every direction that was tried, too: they make the document long.
enum class DirectionsInJson { left_out, included };

/// The document of `workspace`: zwidth.workspace/1.
[[nodiscard]] Json workspace_json(const Device& device, const Workspace& workspace,
                                  DirectionsInJson directions = DirectionsInJson::left_out);

/// A row for every pose and every direction that was tried there, those that were refused too. A pose of which nothing is
/// known is one row without a normal, and a point that the tip does not reach one without a pose.
[[nodiscard]] std::string workspace_csv(const Workspace& workspace);

/// The position of each of Workspace::pose_joints at a pose, m or rad; NaN where it is not known.
[[nodiscard]] std::vector<double> pose_positions(const Workspace& workspace, const WorkspacePose& pose);

/// The motion of each of Workspace::pose_joints.
[[nodiscard]] std::vector<Motion> pose_motions(const Workspace& workspace);

}  // namespace zwidth::results
