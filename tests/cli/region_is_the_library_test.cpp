// What `zwidth region --json` prints is what the library's one call answers, to the last digit: on every device file and
// on random devices.

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "cli/workspace.hpp"
#include "property/random_devices.hpp"
#include "results/region_json.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::cli {
namespace {

class RegionIsTheLibrary : public Workspace {
 protected:
  void expect_equal(const std::string& file) const {
    const Outcome outcome = run("zwidth region --json " + file);
    const auto device = read_device_file((directory() / file).string(), {});
    ASSERT_TRUE(device.has_value()) << device.error().str();
    const WallRegion walls = region(*device);
    EXPECT_EQ(outcome.output, results::line(results::region_json(*device, walls))) << file;
    EXPECT_EQ(outcome.status, walls.trust.refused() ? 1 : 0) << file << outcome.errors;
  }
};

TEST_F(RegionIsTheLibrary, OnEveryDeviceFile) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory() / "devices")) {
    if (entry.path().extension() != ".toml") continue;
    expect_equal("devices/" + entry.path().filename().string());
    ++files;
  }
  EXPECT_GT(files, 3);
}

// Kinds whose limit for any user takes little time.
TEST_F(RegionIsTheLibrary, OnRandomDevices) {
  constexpr std::array<std::string_view, 4> kinds = {"rigid", "transfer_function", "two_mass", "transfer_function"};
  for (unsigned seed = 1; seed <= 200; ++seed) {
    test::RandomDevices random(seed);
    write("random.toml", write_device(random.device(kinds[seed % kinds.size()])));
    expect_equal("random.toml");
  }
}

}  // namespace
}  // namespace zwidth::cli
