// Frames of the serial drives, byte for byte: examples of the firmwares' documents and sources, and what is no frame.
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "rig/odrive_protocol.hpp"
#include "rig/serial_device.hpp"
#include "zwidth/rig/serial_rate.hpp"

namespace zwidth::rig {
namespace {

TEST(OdriveProtocol, IsTheDocumentedOne) {
  EXPECT_EQ(odrive_line("r vbus_voltage ").view(), "r vbus_voltage *93\n");  // docs/ascii-protocol.rst
  EXPECT_EQ(odrive_torque(0, 0.1).view(), "c 0 0.1");
  EXPECT_EQ(odrive_torque(1, -1.25e-7).view(), "c 1 -1.25e-07");
  EXPECT_EQ(odrive_line("f 0").view(), "f 0*118\n");  // 0x66 ^ 0x20 ^ 0x30 = 0x76
  const auto answer = odrive_answer("1.250000 -0.500000*14\r\n");
  ASSERT_TRUE(answer);
  const auto feedback = odrive_feedback(*answer);
  ASSERT_TRUE(feedback);
  EXPECT_EQ(feedback->position, 1.25);
  EXPECT_EQ(feedback->velocity, -0.5);
}

TEST(OdriveProtocol, RefusesEveryFlippedBitAndHalfLines) {
  const std::string line = "1.250000 -0.500000*14\r\n";
  for (std::size_t bit = 0; bit < 8 * (line.size() - 2); ++bit) {
    std::string flipped = line;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    const auto answer = odrive_answer(flipped);
    EXPECT_FALSE(answer && odrive_feedback(*answer)) << "bit " << bit;
  }
  for (std::size_t size = 0; size + 2 < line.size(); ++size) {
    EXPECT_FALSE(odrive_answer(line.substr(0, size))) << size;
  }
  EXPECT_FALSE(odrive_feedback("unknown command"));
  EXPECT_FALSE(odrive_feedback("1.0"));
  EXPECT_FALSE(odrive_feedback("1.0 2.0 3.0"));
}

TEST(SerialRate, SaysWhatALineCarriesAndWhatWouldDo) {
  EXPECT_NEAR(serial_rate(20, 115200), 576.0, 1e-9);
  EXPECT_FALSE(find_problem(SerialLoad{20, 115200, 1.0 / 460.0}));
  const auto problem = find_problem(SerialLoad{20, 115200, 1e-3});
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->what, "20 bytes per cycle at 115200 Bd leave 460 Hz at most, the loop runs at 1000 Hz");
  EXPECT_EQ(problem->allowed, "set the drive and driver.baud to 460800 or more, or loop.sampling_period to 0.0022 s or more");
  EXPECT_FALSE(find_problem(SerialLoad{20, 460800, 1e-3})) << "as it says";
  EXPECT_FALSE(find_problem(SerialLoad{20, 115200, 0.0022})) << "as it says";
}

TEST(MotorDrive, TurnsOfTheMotorAreTheDevices) {
  const MotorDrive belt = *test::belt_device().parameters().driver;
  EXPECT_DOUBLE_EQ(belt.position_per_turn(), -0.0125);
  EXPECT_DOUBLE_EQ(belt.torque_per_force() * 2.0 * 3.141592653589793, -0.0125) << "an ideal gear loses no work";
  EXPECT_DOUBLE_EQ(MotorDrive{}.torque_per_force(), 1.0);
}

}  // namespace
}  // namespace zwidth::rig
