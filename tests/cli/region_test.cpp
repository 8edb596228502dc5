#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class Region : public Workspace {};

TEST_F(Region, AgreesWithAnalyzeAtZeroDamping) {
  const Outcome region = run("zwidth region devices/lhifam_rigid.toml --json");
  const Outcome analysis = run("zwidth analyze devices/lhifam_rigid.toml --json");
  ASSERT_EQ(region.status, 0) << region.errors;
  EXPECT_THAT(region.errors, IsEmpty());
  EXPECT_EQ(std::count(region.output.begin(), region.output.end(), '\n'), 1);
  const auto ours = nlohmann::json::parse(region.output);
  const auto theirs = nlohmann::json::parse(analysis.output);
  EXPECT_NEAR(ours["critical_stiffness"].get<double>() / theirs["critical_stiffness"].get<double>(), 1.0, 1e-9);
  EXPECT_NEAR(ours["any_user"]["limits"][0][0]["stiffness"].get<double>() /
                  theirs["any_user"]["critical_stiffness"].get<double>(),
              1.0, 1e-9);
}

// The walls of the raster, asked one by one of analyze.
TEST_F(Region, RasterIsAnalyzesVerdict) {
  ASSERT_EQ(run("zwidth region devices/lhifam_rigid.toml --set loop.delay=0.5e-3 --set wall.velocity_filter_hz=80 "
                "--raster 3 --csv map.csv")
                .status,
            0);
  std::istringstream lines(contents("map.csv"));
  std::string line;
  std::getline(lines, line);
  int walls = 0;
  while (std::getline(lines, line)) {
    const std::size_t first = line.find(',');
    const std::size_t second = line.find(',', first + 1);
    const Outcome outcome =
        run("zwidth analyze devices/lhifam_rigid.toml --set loop.delay=0.5e-3 "
            "--set wall.velocity_filter_hz=80 --set wall.stiffness=" +
            line.substr(0, first) + " --set wall.damping=" + line.substr(first + 1, second - first - 1) + " --json");
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_EQ(nlohmann::json::parse(outcome.output)["wall"]["stable"].get<bool>(), line[second + 1] == '1') << line;
    EXPECT_EQ(line.substr(second + 2), ",sound");
    ++walls;
  }
  EXPECT_EQ(walls, 9);
}

TEST_F(Region, WritesFigureAndBoundary) {
  const Outcome outcome = run("zwidth region devices/lhifam_rigid.toml -o a.svg --csv a.csv");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(contents("a.svg"), HasSubstr("Stable walls of"));
  EXPECT_THAT(contents("a.csv"), StartsWith("component,boundary,stiffness"));
  EXPECT_THAT(outcome.output, HasSubstr("largest K"));
}

TEST_F(Region, OfASlowDamperIsDrawnAroundBothAtItsRate) {
  const Outcome outcome =
      run("zwidth region devices/lhifam_rigid.toml --set loop.sampling_period=50e-6 "
          "--set loop.damper.sampling_period=0.5e-3 -o a.svg");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(contents("a.svg"), HasSubstr("both at 2 kHz: up to 14.83 MN/m"));
}

TEST_F(Region, RefusesWhatItCannotDoBeforeAnyWork) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"devices/lhifam.toml -o a.bmp", "--output: a.bmp: unknown extension"},
      {"devices/lhifam.toml --raster 10", "--raster: is for a csv file"},
      {"devices/lhifam.toml --raster 1 --csv a.csv", "--raster"},
      {"devices/lhifam.toml --csv devices/lhifam.toml", "would overwrite the device file"},
      {"devices/lhifam.toml devices/lhifam_rigid.toml", "zwidth: "},
      {"missing.toml", "missing.toml"},
      {"devices/lhifam.toml --set wall.velocity_filter_hz=-1", "wall.velocity_filter_hz"},
  };
  for (const auto& [arguments, message] : cases) expect_refusal("zwidth region " + arguments, message);
  EXPECT_FALSE(std::filesystem::exists(directory() / "a.csv"));
}

TEST_F(Region, OfATransferFunctionHasNeitherUsersNorFormulas) {
  write("plant.toml",
        "[transfer_function]\nnumerator = [1.0]\ndenominator = [1.0, 1.0]\n[loop]\nsampling_period = 1.0\n");
  const Outcome outcome = run("zwidth region plant.toml --json -o a.png");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto document = nlohmann::json::parse(outcome.output);
  EXPECT_TRUE(document["any_user"].is_null());
  EXPECT_TRUE(document["approximations"].empty());
  EXPECT_THAT(contents("a.png"), StartsWith("\x89PNG"));
}

}  // namespace
}  // namespace zwidth::cli
