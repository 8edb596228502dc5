#pragma once

#include <CLI/App.hpp>

#include "zwidth/workspace.hpp"

namespace zwidth::cli {

/// Hands over every limit of a workspace, which its document does not hold: nothing is done on the command line.
///
/// Series "shape" = (poses, directions), and row by row "nobody" and "any_user" (N/m; infinity: unbounded, NaN: refused, or
/// no such direction at that pose) and "normals" (three each). A column is one of options.normals where those were given;
/// else the directions of a pose stand in their order, those without a limit last.
void hand_over_limits(const CLI::App& command, const Workspace& workspace, const WorkspaceOptions& options);

}  // namespace zwidth::cli
