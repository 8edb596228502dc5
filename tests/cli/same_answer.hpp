#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "cli/workspace.hpp"

namespace zwidth::cli {

/// What a command must print on standard output, and its exit status.
struct Answer {
  std::string output;
  int status = 0;
};

/// One run of the program, and the library's answer to the same.
struct Question {
  std::string command;  ///< "analyze FILE --json"
  /// An Error or bad input thrown by it must be a failure of the command, with nothing on standard output.
  std::function<Answer()> answer;
};

/// Where what the program prints is compared, byte for byte, with one call of the library as the fronts' results write
/// it.
class SameAnswer : public Workspace {
 protected:
  /// Runs all the commands while the library answers the questions. At most a twentieth may fail.
  void expect_same(const std::vector<Question>& questions) const;
};

}  // namespace zwidth::cli
