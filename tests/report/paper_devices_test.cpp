#include "reproduce/paper_devices.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "zwidth/io/device_file.hpp"

namespace zwidth::report {
namespace {

/// Everything that decides the numbers; names are the files' own affair.
void expect_same_physics(const DeviceParameters& ours, const std::string& file) {
  const auto device = read_device_file(ZWIDTH_SOURCE_DIR "/devices/" + file);
  ASSERT_TRUE(device) << device.error().str();
  const DeviceParameters& theirs = device->parameters();
  ASSERT_EQ(ours.bodies.size(), theirs.bodies.size());
  for (std::size_t i = 0; i < ours.bodies.size(); ++i) {
    EXPECT_EQ(ours.bodies[i].mass, theirs.bodies[i].mass);
    EXPECT_EQ(ours.bodies[i].damping, theirs.bodies[i].damping);
    EXPECT_EQ(ours.bodies[i].stiffness, theirs.bodies[i].stiffness);
  }
  ASSERT_EQ(ours.links.size(), theirs.links.size());
  for (std::size_t i = 0; i < ours.links.size(); ++i) {
    EXPECT_EQ(ours.links[i].stiffness, theirs.links[i].stiffness);
    EXPECT_EQ(ours.links[i].damping, theirs.links[i].damping);
  }
  EXPECT_EQ(ours.loop.actuated, theirs.loop.actuated);
  EXPECT_EQ(ours.loop.sensed, theirs.loop.sensed);
  EXPECT_EQ(ours.loop.held, theirs.loop.held);
  EXPECT_EQ(ours.loop.sampling_period, theirs.loop.sampling_period);
  EXPECT_EQ(ours.loop.delay, theirs.loop.delay);
  EXPECT_EQ(ours.sensor.resolution, theirs.sensor.resolution);
  EXPECT_EQ(ours.actuator.time_constant, theirs.actuator.time_constant);
}

TEST(PaperDevices, EqualTheDeviceFiles) {
  expect_same_physics(paper_lhifam(), "lhifam.toml");
  expect_same_physics(paper_lhifam_reduced_pretension(), "lhifam_reduced_pretension.toml");
  expect_same_physics(paper_lhifam_rigid(), "lhifam_rigid.toml");
  expect_same_physics(handle_sensed(paper_lhifam()), "lhifam_handle_sensed.toml");
}

TEST(PaperDevices, Table2IsAsPrinted) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/table2.csv");
  std::string line;
  std::getline(file, line);
  for (const PaperTrial& trial : paper_table_2()) {
    ASSERT_TRUE(std::getline(file, line));
    std::istringstream fields(line);
    double delay_ms = 0.0;
    double frequency = 0.0;
    double margin = 0.0;
    char comma = 0;
    fields >> delay_ms >> comma >> frequency >> comma >> margin;
    EXPECT_DOUBLE_EQ(trial.delay, 1e-3 * delay_ms);
    EXPECT_EQ(trial.frequency_hz, frequency);
    EXPECT_EQ(trial.margin_db, margin);
  }
}

}  // namespace
}  // namespace zwidth::report
