#pragma once

#include <string>
#include <vector>

#include "zwidth/workspace.hpp"

namespace zwidth::cli {

/// What of a workspace is looked at, as the command line says it.
struct WorkspaceOptionTexts {
  std::vector<std::string> poses;    ///< "shoulder=0:90:19 deg,elbow=30 deg", each; "elbow=1;elbow=2"
  std::vector<std::string> points;   ///< "0.3,0.1,0;0.4,0,0", each
  std::vector<std::string> normals;  ///< "1,0,0;0,1,0", each; or a number of directions alone
};

/// Sets grid, points, normals and directions. Throws BadInput, naming the option, for a text that states none.
///
/// `poses`: JOINT=FIRST:LAST:COUNT or JOINT=VALUE; a unit behind the count is that of both ends. Numbers without a unit are
/// rad or m. Poses parted by a semicolon are a list, in which each joint has one value. `points`: three lengths, m or with
/// a unit; one behind the last is that of all three.
void apply(const WorkspaceOptionTexts& texts, WorkspaceOptions& options);

}  // namespace zwidth::cli
