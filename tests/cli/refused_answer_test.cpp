// What a device file says of its own numbers goes through every command: in words, in documents, in files, and whether
// it changes the exit status. "Refused" is an answer, status 0; a file that it cannot fill is work that failed, 1.

#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string reason = "nobody weighed the handle";

// Commands whose answer is a limit, or rests on one, as they stand before a file's name and after it.
struct Asked {
  std::string command;
  std::string options;
};
const std::vector<Asked> asked = {{"analyze", ""},
                                  {"analyze", "--worst-user --users mass=0:1"},
                                  {"bode", ""},
                                  {"region", ""},
                                  {"design", ""},
                                  {"design", "--sweep loop.delay=0:1e-3:3 --any-user"},
                                  {"design", "--compare sensed=motor,handle"},
                                  {"design", "--target 9000"},
                                  {"design", "--target 9000 --any-user"},
                                  {"design", "--notch --phase-margin-deg 0"},
                                  {"design", "--recommend"},
                                  {"diagnose", "--oscillates-hz 41"},
                                  {"relay", "--amplitude 5 --duration 6 --trials 1"},
                                  {"simulate", "--duration 1"},
                                  {"study", "--study study.toml"}};

class TrustedOrNot : public Workspace, public testing::WithParamInterface<std::string> {
 protected:
  TrustedOrNot() {
    write("device.toml", contents("devices/lhifam.toml") + "\n[wall]\nstiffness = 3000\n[uncertainty]\nverdict = \"" +
                             GetParam() + "\"\nreasons = [\"" + reason + "\"]\n");
    write("study.toml",
          "samples = 60\nspecification.critical_stiffness = 300\n[[parameter]]\nkey = \"link.stiffness\"\n"
          "distribution = \"uniform\"\nrelative_tolerance = 0.2\n");
  }
  [[nodiscard]] Outcome answer(const Asked& each, const std::string& more) const {
    return run("zwidth " + each.command + " device.toml " + each.options + " " + more);
  }
};

TEST_P(TrustedOrNot, IsSaidByEveryCommandInWordsAndInItsDocument) {
  const std::string loud = GetParam() == "refused" ? "REFUSED" : "DOUBTFUL";
  for (const Asked& each : asked) {
    SCOPED_TRACE(each.command + " " + each.options);
    const Outcome words = answer(each, "");
    EXPECT_EQ(words.status, 0) << words.errors;
    EXPECT_THAT(words.output.substr(0, 400), HasSubstr(loud));
    EXPECT_THAT(words.output.substr(0, 600), HasSubstr(reason));
    const Outcome document = answer(each, "--json");
    EXPECT_EQ(document.status, 0) << document.errors;
    const json trust = json::parse(document.output)["trust"];
    EXPECT_EQ(trust["verdict"], GetParam());
    EXPECT_THAT(trust["reasons"].dump(), HasSubstr(reason));
  }
}

TEST_P(TrustedOrNot, IsInTheFilesThatStateLimits) {
  const bool refused = GetParam() == "refused";
  const std::vector<Asked> files = {{"region", "--csv out.csv"},
                                    {"region", "--raster 5 --csv out.csv"},
                                    {"design", "--sweep loop.delay=0:1e-3:3 --output out.csv"},
                                    {"study", "--study study.toml --output-device out.csv"},
                                    {"design", "--recommend --write out.csv"},
                                    {"export", "--format chai3d --output out.csv"}};
  for (const Asked& each : files) {
    SCOPED_TRACE(each.command + " " + each.options);
    const Outcome outcome = answer(each, "");
    EXPECT_EQ(outcome.status, refused ? 1 : 0) << outcome.errors;
    if (refused) {
      EXPECT_THAT(outcome.errors, HasSubstr(reason));
      EXPECT_THAT(contents("out.csv"), ::testing::IsEmpty());
    } else {
      EXPECT_THAT(contents("out.csv"), ::testing::AnyOf(HasSubstr("doubtful"), HasSubstr("DOUBTFUL")));
      std::filesystem::remove(directory() / "out.csv");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Verdicts, TrustedOrNot, testing::Values("doubtful", "refused"),
                         [](const auto& verdict) { return verdict.param; });

}  // namespace
}  // namespace zwidth::cli
