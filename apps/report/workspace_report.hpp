#pragma once

#include <string>

#include "report/text/findings_text.hpp"
#include "zwidth/workspace.hpp"

namespace zwidth::report {

/// The answer of `workspace` for an engineer: the least limits, where and along which normal, how limits spread, and the
/// poses with the least of them; where none is known, why.
[[nodiscard]] std::string workspace_text(const Device& device, const Workspace& workspace, ShownFindings shown);

/// The same as a page, with a map. Throws OutputFailed.
[[nodiscard]] std::string workspace_page(const Device& device, const Workspace& workspace);

/// The device at the pose and normal of the least limit, of any passive user where that is known: a file of its own, with the
/// trust of the workspace. Its mechanism's file is called as one in `folder`, where it lies there. Requires that there is one.
[[nodiscard]] std::string worst_pose_file(const Device& device, const Workspace& workspace, const std::string& folder);

}  // namespace zwidth::report
