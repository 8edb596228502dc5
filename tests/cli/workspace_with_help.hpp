#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "cli/workspace.hpp"

namespace zwidth::cli {

/// A workspace that knows the program's commands.
class WorkspaceWithHelp : public Workspace {
 protected:
  /// Names of the commands, from the program's own help.
  [[nodiscard]] std::vector<std::string> commands() const {
    std::vector<std::string> names;
    std::istringstream help(run("zwidth --help").output);
    bool in_list = false;
    for (std::string line; std::getline(help, line);) {
      if (line.empty()) in_list = false;
      if (in_list) names.push_back(line.substr(2, line.find(' ', 2) - 2));
      if (line == "Commands:") in_list = true;
    }
    return names;
  }
};

}  // namespace zwidth::cli
