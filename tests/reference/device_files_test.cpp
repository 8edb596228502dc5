#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

namespace fs = std::filesystem;

const fs::path devices_folder = fs::path(ZWIDTH_SOURCE_DIR) / "devices";

TEST(DeviceFiles, AllAreReadWithASourceAndANameOfTheirOwn) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(devices_folder)) {
    SCOPED_TRACE(entry.path().filename().string());
    if (entry.is_directory()) continue;  // studies of them
    ASSERT_EQ(entry.path().extension(), ".toml");
    const auto device = read_device_file(entry.path().string());
    ASSERT_TRUE(device.has_value()) << device.error().str();
    EXPECT_TRUE(names.insert(device->name()).second) << "the name stands in another file too";
    std::string first_line;
    std::getline(std::ifstream(entry.path()) >> std::ws, first_line);
    EXPECT_EQ(first_line.substr(0, 2), "# ") << "a device file begins with its source";
  }
  EXPECT_GE(names.size(), 6U);
}

TEST(DeviceFiles, LhifamIsTableOne) {
  const auto device = read_device_file((devices_folder / "lhifam.toml").string());
  ASSERT_TRUE(device.has_value()) << device.error().str();
  ASSERT_EQ(device->bodies().size(), 2U);
  EXPECT_EQ(device->bodies()[0].mass, 0.3);
  EXPECT_EQ(device->bodies()[0].damping, 0.1);
  EXPECT_EQ(device->bodies()[1].mass, 5.1);
  EXPECT_EQ(device->bodies()[1].damping, 3.4);
  EXPECT_EQ(device->links()[0].stiffness, 79.5e3);
  EXPECT_EQ(device->links()[0].damping, 15.0);
  EXPECT_EQ(device->loop().sampling_period, 1e-3);
  EXPECT_EQ(device->parameters().sensor.resolution, 3.14e-6);
  EXPECT_FALSE(device->parameters().wall.stiffness.has_value());
}

TEST(DeviceFiles, ReducedPretensionSaysThatItIsInferred) {
  const auto device = read_device_file((devices_folder / "lhifam_reduced_pretension.toml").string());
  ASSERT_TRUE(device.has_value()) << device.error().str();
  EXPECT_EQ(device->links()[0].stiffness, 27.55e3);
  EXPECT_EQ(device->links()[0].damping, 10.5);
  EXPECT_NE(device->name().find("inferred"), std::string::npos);
}

}  // namespace
}  // namespace zwidth
