// What `zwidth analyze --json` prints is what the library's one call answers, to the last digit: on every device file
// and on random devices.

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "cli/workspace.hpp"
#include "property/random_devices.hpp"
#include "results/analysis_json.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::cli {
namespace {

class AnalyzeIsTheLibrary : public Workspace {
 protected:
  void expect_equal(const std::vector<std::string>& files) const {
    std::string command = "zwidth analyze --json";
    for (const std::string& file : files) command += " " + file;
    const Outcome outcome = run(command);
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    std::istringstream lines(outcome.output);
    for (const std::string& file : files) {
      std::string line;
      ASSERT_TRUE(std::getline(lines, line)) << file;
      const auto device = read_device_file((directory() / file).string(), {});
      ASSERT_TRUE(device.has_value()) << device.error().str();
      EXPECT_EQ(line + "\n", results::line(results::analysis_json(*device, analyze(*device)))) << file;
    }
  }
};

TEST_F(AnalyzeIsTheLibrary, OnEveryDeviceFile) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(directory() / "devices")) {
    if (entry.path().extension() == ".toml") files.push_back("devices/" + entry.path().filename().string());
  }
  ASSERT_GT(files.size(), 3U);
  expect_equal(files);
}

TEST_F(AnalyzeIsTheLibrary, OnRandomDevices) {
  std::vector<std::string> files;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    test::RandomDevices random(seed);
    DeviceParameters device = random.device(test::device_kinds[seed % test::device_kinds.size()]);
    if (random.chance(0.5)) device.wall.stiffness = random.log_uniform(1.0, 1e5);
    files.push_back("random_" + std::to_string(seed) + ".toml");
    write(files.back(), write_device(device));
  }
  expect_equal(files);
}

}  // namespace
}  // namespace zwidth::cli
