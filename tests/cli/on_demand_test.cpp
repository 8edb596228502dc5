// What the program loads at the first call, where it is missing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

class LoadedOnDemand : public Workspace {};

TEST_F(LoadedOnDemand, AFitThatCannotBeLoadedIsAnErrorAndOtherAnswersStay) {
  const std::string alone =
      "mkdir -p alone/bin && cp \"$(command -v zwidth)\" alone/bin && PATH=$PWD/alone/bin:$PATH && ";
  const Outcome answered = run(alone + "zwidth analyze devices/lhifam.toml --json");
  EXPECT_EQ(answered.status, 0) << answered.errors;
  const Outcome refused = run(alone +
                              "zwidth identify recordings/locked_chirp.csv --force force --position position "
                              "--structure two-body --locked handle --json");
  EXPECT_EQ(refused.status, 1) << refused.output;
  EXPECT_EQ(refused.output, "");
  EXPECT_THAT(refused.errors, ::testing::HasSubstr("fits-"));
}

}  // namespace
}  // namespace zwidth::cli
