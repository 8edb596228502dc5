// No command answers for a device whose damper runs in a loop of its own as for one of one rate: it gives another answer, or
// refuses and names the loop.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;

class TwoRates : public Workspace, public testing::WithParamInterface<std::string_view> {
 protected:
  [[nodiscard]] Outcome answer(std::string_view loop) const {
    std::string command = "zwidth " + std::string(GetParam());
    const std::string device =
        "devices/lhifam.toml --set wall.stiffness=4000 --set wall.damping=50 " + std::string(loop);
    return run(command.replace(command.find("FILE"), 4, device));
  }
};

TEST_P(TwoRates, AreNotAnsweredAsOne) {
  const Outcome one = answer("");
  ASSERT_EQ(one.status, 0) << one.errors;
  for (const std::string_view loop :
       {"--set loop.damper.sampling_period=1e-4", "--set loop.damper.sampling_period=2e-3"}) {
    SCOPED_TRACE(loop);
    const Outcome two = answer(loop);
    if (two.status == 0) {
      EXPECT_NE(two.output, one.output);
    } else {
      EXPECT_EQ(two.status, 2) << two.errors;
      EXPECT_THAT(two.errors, HasSubstr("loop.damper"));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Command, TwoRates,
    testing::Values("analyze FILE --json", "bode FILE", "bode FILE --json", "design FILE --json",
                    "design FILE --recommend --json", "design FILE --target 20000 --json",
                    "design FILE --sweep loop.delay=0:1e-3:3 --json", "diagnose FILE --oscillates-hz 130 --json",
                    "region FILE --json", "export FILE --format octave", "export FILE --format python",
                    "export FILE --format json", "export FILE --format c", "export FILE --format chai3d",
                    "export FILE --units moteus --set driver.travel=0.06", "relay FILE --amplitude 5 --trials 1 --json",
                    "simulate FILE --json",
                    "study FILE --study devices/studies/lhifam.toml --samples 20 --index-samples 0 --json",
                    "identify --structure FILE --limit K=30e3,B=50,hz=110 --json"));

}  // namespace
}  // namespace zwidth::cli
