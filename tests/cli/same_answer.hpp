#pragma once

#include <cstddef>
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
  std::string command;  ///< "analyze FILE --json"; its words are parted by blanks
  /// An Error or bad input thrown by it must be a failure of the command, with nothing on standard output.
  std::function<Answer()> answer;
  std::string file = {};  ///< that the command writes: what is in it is compared behind what is printed
};

/// Where what the program prints is compared, byte for byte, with one call of the library as the fronts' results write
/// it. A program for each would take longer to start than to answer: see started_once/started_once.cpp.
class SameAnswer : public Workspace {
 protected:
  /// Runs all the commands while the library answers the questions. At most 5 % of them may fail.
  void expect_same(const std::vector<Question>& questions) const;
};

/// How many devices or recordings each command is compared on: `usual`, or ZWIDTH_CAMPAIGN_DEVICES.
[[nodiscard]] std::size_t how_many(std::size_t usual);

/// One run of each kind that is compared: "region FILE --json".
[[nodiscard]] std::vector<std::string> commands_compared_on_devices();
[[nodiscard]] std::vector<std::string> commands_compared_on_recordings();

}  // namespace zwidth::cli
