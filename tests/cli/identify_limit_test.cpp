// Measured limits on the command line: --limit "K=3, B=0, hz=40".

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using nlohmann::json;

const std::string on_lhifam = "zwidth identify --structure devices/lhifam.toml --free body.handle.damping ";

class IdentifyLimit : public Workspace {
 protected:
  [[nodiscard]] std::string answer(const std::string& limit) const {
    const Outcome outcome = run(on_lhifam + "--json --limit " + limit);
    EXPECT_EQ(outcome.status, 0) << limit << "\n" << outcome.errors;
    return outcome.output;
  }
};

// The damping that the limit of 2 b / T hangs on, 3.5 N s/m in the file, is about 3.1 N s/m of a device that oscillates from 8 kN/m on.
TEST_F(IdentifyLimit, IsDataByItself) {
  const json found = json::parse(answer("'K=8000, hz=6'"));
  EXPECT_EQ(found.at("schema"), "zwidth.identification/1");
  EXPECT_EQ(found.at("method"), "limits");
  EXPECT_TRUE(found.at("band_hz").is_null());
  EXPECT_NEAR(found.at("critical_stiffness").get<double>(), 8000.0, 400.0);
  EXPECT_LT(found.at("critical_stiffness_interval").at(0).get<double>(), 8000.0);
  EXPECT_GT(found.at("critical_stiffness_interval").at(1).get<double>(), 8000.0);
}

TEST_F(IdentifyLimit, IsTheSameInAnyOrderUnitAndCase) {
  const std::string plain = answer("'K=8000, B=0, hz=6'");
  EXPECT_EQ(answer("'hz=6 Hz,K=8 kN/m'"), plain);
  EXPECT_EQ(answer("' k = 8000 , Hz = 6 '"), plain);
}

TEST_F(IdentifyLimit, NamesItsOptionWhereItIsRefused) {
  expect_refusal(on_lhifam + "--limit 'B=0, hz=40'", "--limit: ");
  expect_refusal(on_lhifam + "--limit 'K=3 kg'", "--limit: K: ");
}

TEST_F(IdentifyLimit, StandsBesideARecordingOrInItsPlace) {
  expect_refusal("zwidth identify --structure devices/lhifam.toml",
                 "FILE: missing; a recording to fit to, or a measured limit");
  expect_refusal(on_lhifam + "--limit K=8000 --force force", "--force: is for a recording");
  expect_refusal(on_lhifam + "--limit K=8000 --method time-domain", "--method: is for a recording");
  expect_refusal(on_lhifam + "--limit K=8000 --figure fit.svg", "--figure: is of the response of a recording");
  expect_refusal(
      "zwidth identify recordings/free_motion.csv --force force --position position --method inverse-dynamics --limit "
      "K=8000",
      "--limit: is not for --method inverse-dynamics");
}

}  // namespace
}  // namespace zwidth::cli
