// No command is forgotten by the tables of what is compared with the library's answers.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cli/same_answer.hpp"
#include "cli/workspace_with_help.hpp"

namespace zwidth::cli {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class SameAnswerEverywhere : public WorkspaceWithHelp {
 protected:
  SameAnswerEverywhere() : compared_(commands_compared_on_devices()) {
    const std::vector<std::string> on_recordings = commands_compared_on_recordings();
    compared_.insert(compared_.end(), on_recordings.begin(), on_recordings.end());
  }

  /// The words that the help allows as the value of an option: "--method NAME:{a,b}".
  [[nodiscard]] std::vector<std::string> choices(const std::string& command, const std::string& option) const {
    const std::string help = run("zwidth " + command + " --help").output;
    const std::size_t begin = help.find('{', help.find("\n  " + option + " ")) + 1;
    std::vector<std::string> words(1);
    for (std::size_t at = begin; at < help.size() && help[at] != '}'; ++at) {
      if (help[at] == ',') {
        words.emplace_back();
      } else if (help[at] != '\n' && help[at] != ' ') {
        words.back() += help[at];
      }
    }
    return words;
  }

  std::vector<std::string> compared_;
};

TEST_F(SameAnswerEverywhere, EveryCommandThatTakesADeviceOrARecording) {
  const std::vector<std::string> all = commands();
  EXPECT_GT(all.size(), 10U);
  for (const std::string& command : all) {
    if (command == "reproduce") continue;  // writes the paper again; takes neither
    if (command == "serve") continue;      // its documents are compared in serve_documents_test.cpp
    if (command == "rig") continue;        // acts on a device: no request does
    if (command == "workspace") continue;  // of mechanisms alone: mechanism_workspace_test.cpp
    EXPECT_THAT(compared_, Contains(StartsWith(command + " ")));
  }
}

TEST_F(SameAnswerEverywhere, EveryFormatAndEveryMethod) {
  const std::vector<std::string> formats = choices("export", "--format");
  EXPECT_GT(formats.size(), 4U);
  for (const std::string& format : formats) EXPECT_THAT(compared_, Contains(HasSubstr("--format " + format)));
  const std::vector<std::string> methods = choices("identify", "--method");
  EXPECT_GT(methods.size(), 2U);
  for (const std::string& method : methods) {
    const std::string asked = method == "time-domain" ? "identify FILE" : "--method " + method;
    EXPECT_THAT(compared_, Contains(HasSubstr(asked)));
  }
}

TEST_F(SameAnswerEverywhere, EveryQuestionOfDesignAndBothSourcesOfRelayAndDiagnose) {
  for (const char* asked : {"design FILE --json", "--sweep", "--compare", "--target", "--notch", "--recommend",
                            "relay FILE", "relay --recording", "diagnose FILE", "diagnose DEVICE --recording"}) {
    EXPECT_THAT(compared_, Contains(HasSubstr(asked)));
  }
}

}  // namespace
}  // namespace zwidth::cli
