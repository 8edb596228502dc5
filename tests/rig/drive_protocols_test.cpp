// Frames of the serial drives, byte for byte: examples of the firmwares' documents and sources, and what is no frame.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "rig/moteus_protocol.hpp"
#include "rig/odrive_protocol.hpp"
#include "rig/serial_device.hpp"
#include "rig/simplefoc_protocol.hpp"
#include "rig/vesc_protocol.hpp"
#include "zwidth/rig/serial_rate.hpp"

namespace zwidth::rig {
namespace {

TEST(OdriveProtocol, IsTheDocumentedOne) {
  EXPECT_EQ(odrive_line("r vbus_voltage ").view(), "r vbus_voltage *93\n");  // docs/ascii-protocol.rst
  EXPECT_EQ(odrive_torque(0, 0.1).view(), "c 0 0.1");
  EXPECT_EQ(odrive_torque(1, -1.25e-7).view(), "c 1 -1.25e-07");
  EXPECT_EQ(odrive_damped_torque(0, -0.25).view(), "v 0 0 -0.25");  // velocity, then the torque beside its loop
  EXPECT_EQ(odrive_line("f 0").view(), "f 0*118\n");                // 0x66 ^ 0x20 ^ 0x30 = 0x76
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

TEST(MoteusProtocol, IsTheDocumentedOne) {
  EXPECT_EQ(moteus_line("can send 8001 01000a07206000200150ff140400130d", true).view(),
            "can send 8001 01000a07206000200150ff140400130d *12\n");
  EXPECT_EQ(moteus_line("can send 8001 01000a", false).view(), "can send 8001 01000a\n");
  const auto reply = moteus_reply("rcv 100 2404000a005000000170ff230d181400", 1);  // docs/protocol/can.md
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->mode, 10);
  EXPECT_NEAR(*reply->position, 0.0080, 1e-15) << "2.88 degrees";
  EXPECT_EQ(reply->fault, 0);
  // By hand from docs/protocol/can.md: write mode 10; float 1.5 at 0x22; two int8 0 at 0x23; float 0.1 at 0x27.
  EXPECT_EQ(moteus_torque(1, 1.5, 0.1).view(), "can send 0001 01000a0d220000c03f022300000d27cdcccc3d");
  EXPECT_EQ(moteus_stop(1).view(), "can send 0001 010000");
  // The same with two floats at 0x20, no position and velocity 0; two int8 of the whole at 0x23; float 2 at 0x25.
  EXPECT_EQ(moteus_damped_torque(1, 1.5, 2.0, 0.1).view(),
            "can send 0001 01000a0e200000c07f000000000d220000c03f02237f7f0d25000000400d27cdcccc3d");
  EXPECT_EQ(moteus_damped_torque(1, 1.5, {}, 0.1).view(),
            "can send 0001 01000a0e200000c07f000000000d220000c03f02237f7f0d27cdcccc3d");
  // docs/protocol/can.md: 0x40 to, 0x42 asks, 0x41 from the diagnostic stream of channel 1.
  EXPECT_EQ(moteus_tunnel(1, "OK\n").view(), "can send 0001 4001034f4b0a");
  EXPECT_EQ(moteus_tunnel_question(1).view(), "can send 8001 420130");
  EXPECT_EQ(moteus_tunnel_reply("rcv 100 4101044f4b0d0a", 1), "OK");
  EXPECT_FALSE(moteus_tunnel_reply("rcv 100 410100", 1)) << "it says nothing";
  EXPECT_FALSE(moteus_tunnel_reply("rcv 100 4101054f4b0d0a", 1)) << "half";
  const std::string longest = "conf set servo.pid_position.kd -1.23457e-05\n";
  EXPECT_TRUE(moteus_line(moteus_tunnel(127, longest).view(), true).view().ends_with("\n")) << "it fits";
  // docs/protocol/can.md: 0x19 reads one int32, register 0x101 as varuint; its answer 1.1.0.
  EXPECT_EQ(moteus_version_question(17).view(), "can send 8011 198102");
  EXPECT_EQ(moteus_reply("rcv 100 29810200010100", 1).value().firmware, 0x010100);
  EXPECT_FALSE(moteus_reply("rcv 100 298182", 1)) << "a register of three bytes";
  EXPECT_EQ(moteus_question(17).view(), "can send 8011 11001d01");
  EXPECT_EQ(moteus_mark(17).view(), "can send 8011 110f") << "one int8 from register 15";
  const auto flagged = moteus_reply("rcv 0100 21000A2D010000C03F505050 E B F r t12345 f0", 1);  // of an fdcanusb
  ASSERT_TRUE(flagged);
  EXPECT_EQ(flagged->position, 1.5);
  EXPECT_FALSE(moteus_reply("rcv 200 21000a", 1)) << "of another drive";
}

TEST(MoteusProtocol, RefusesEveryFlippedBitAndHalfLines) {
  const std::string line(moteus_line("rcv 00000100 21000a2d010000c03f", true).view());
  ASSERT_TRUE(moteus_answer(line, true));
  for (std::size_t bit = 0; bit < 8 * (line.size() - 1); ++bit) {
    std::string flipped = line;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    const auto answer = moteus_answer(flipped, true);
    // The case of a checksum's letters says nothing.
    EXPECT_TRUE(!answer || *answer == *moteus_answer(line, true)) << "bit " << bit;
  }
  for (std::size_t size = 0; size + 1 < line.size(); ++size) EXPECT_FALSE(moteus_answer(line.substr(0, size), true));
  const std::string reply = "rcv 00000100 21000a2d010000c03f";
  for (std::size_t size = 0; size < reply.size(); ++size) {
    const auto half = moteus_reply(reply.substr(0, size), 1);
    EXPECT_FALSE(half && half->position) << size;
  }
}

std::string hexadecimal(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) text += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return text;
}

TEST(VescProtocol, IsThatOfItsSources) {
  EXPECT_EQ(hexadecimal(vesc_packet("\x04").view()), "020104408403") << "GET_VALUES";
  EXPECT_EQ(hexadecimal(vesc_current(1.5).view()), "020506000005dc388103") << "SET_CURRENT 1.5 A";
  EXPECT_EQ(hexadecimal(vesc_question().view()).substr(0, 14), "02053200218000") << "selective: bits 15, 16 and 21";
  // By hand from comm/commands.c: 50, the mask, fault 0, 90 degrees in millionths, status 0.
  const std::string payload("\x32\x00\x21\x80\x00\x00\x05\x5d\x4a\x80\x00", 11);
  const auto values = vesc_values(payload);
  ASSERT_TRUE(values);
  EXPECT_EQ(values->fault, 0);
  EXPECT_DOUBLE_EQ(values->position, 0.25);
  EXPECT_FALSE(values->has_let_go);
  EXPECT_FALSE(vesc_values(payload.substr(0, 10))) << "of firmware before 6.00";
  EXPECT_FALSE(is_vesc_mark(payload));
  EXPECT_EQ(hexadecimal(vesc_mark().view()).substr(0, 14), "02053200200000") << "bit 21";
  const std::string status("\x32\x00\x20\x00\x00\x00", 6);
  EXPECT_TRUE(is_vesc_mark(status));
  EXPECT_FALSE(vesc_values(status));
}

// confgenerator.c of 6.06 (signature 788332866): p_pid_ang_div at 367, cc_min_current at 379; packet.c.
TEST(VescProtocol, TellsItsFirmwareAndItsSettings) {
  EXPECT_EQ(hexadecimal(vesc_version_question().view()), "020100000003");
  EXPECT_EQ(hexadecimal(vesc_settings_question().view()), "02010ee1ce03");
  const auto version = vesc_version(std::string("\x00\x06\x05HW\x00", 6));
  ASSERT_TRUE(version);
  EXPECT_EQ(version->major, 6);
  EXPECT_EQ(version->minor, 5);
  std::string payload(1 + 483, '\0');
  payload[0] = 14;
  payload.replace(1, 4, "\x2e\xfd\x01\x42", 4);
  payload.replace(1 + 367, 4, "\x40\x00\x00\x00", 4);  // 2
  payload.replace(1 + 379, 4, "\x3d\x4c\xcc\xcd", 4);  // 0.05
  const auto settings = vesc_settings(payload);
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->angle_division, 2.0);
  EXPECT_FLOAT_EQ(static_cast<float>(settings->least_current), 0.05F);
  EXPECT_FALSE(vesc_settings(payload.substr(0, 1 + 382))) << "half";
  std::string other = payload;
  other[4] = 0;
  EXPECT_TRUE(has_vesc_settings(other));
  EXPECT_FALSE(vesc_settings(other)) << "of another signature";
  payload.replace(1 + 367, 4, "\x7f\xc0\x00\x00", 4);
  EXPECT_FALSE(vesc_settings(payload)) << "no number";
  // The end of a torn packet, and what follows, is no long one where none was asked for.
  const std::string packet(vesc_packet(payload).view());
  EXPECT_EQ(hexadecimal(packet).substr(0, 6), "0301e4") << "a length of two bytes";
  EXPECT_EQ(vesc_packet_size(packet, vesc_long_payload), packet.size());
  EXPECT_EQ(vesc_payload(packet), payload);
  EXPECT_EQ(vesc_packet_size(packet), 1U);
  EXPECT_EQ(vesc_packet_size(packet.substr(0, 300), vesc_long_payload), 0U);
}

TEST(VescProtocol, RefusesEveryFlippedBitAndHalfPackets) {
  const std::string packet(vesc_current(-12.345).view());
  ASSERT_EQ(vesc_packet_size(packet), packet.size());
  for (std::size_t bit = 0; bit < 8 * packet.size(); ++bit) {
    std::string flipped = packet;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    EXPECT_FALSE(vesc_payload(flipped)) << "bit " << bit;
  }
  for (std::size_t size = 0; size < packet.size(); ++size) {
    EXPECT_EQ(vesc_packet_size(packet.substr(0, size)), 0U) << size;
    EXPECT_FALSE(vesc_payload(packet.substr(0, size))) << size;
  }
  EXPECT_EQ(vesc_packet_size("x" + packet), 1U) << "noise before it";
}

// docs.simplefoc.com, commander_interface; the echo by src/communication/Commander.cpp, printMachineReadable().
TEST(SimplefocProtocol, IsTheDocumentedOne) {
  EXPECT_EQ(simplefoc_target("M", 0.5).view(), "M0.5\n");
  EXPECT_EQ(simplefoc_line("M", "MG6").view(), "MMG6\n");
  EXPECT_EQ(simplefoc_line("A", "E0").view(), "AE0\n");
  EXPECT_EQ(simplefoc_answer("MMG-1.250000\r\n", "M", "MG"), "-1.250000");
  EXPECT_FALSE(simplefoc_answer("M0.500000\r\n", "M", "MG")) << "the echo of a target";
  EXPECT_FALSE(simplefoc_answer("err\r\n", "M", "MG"));
}

TEST(SimplefocProtocol, NoLineFillsTheBufferOf20Characters) {
  for (const double target : {0.0, -0.0, 1.0 / 3.0, -1.234567e-300, 1.234567e300, -123456.789}) {
    EXPECT_LT(simplefoc_target("M", target).view().size(), 20U) << target;
  }
}

TEST(SerialRate, SaysWhatALineCarriesAndWhatWouldDo) {
  EXPECT_NEAR(serial_rate(20, 115200), 576.0, 1e-9);
  EXPECT_FALSE(find_problem(SerialLoad{20, 115200, 1.0 / 460.0}));
  const auto problem = find_problem(SerialLoad{20, 115200, 1e-3});
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->what, "20 bytes per cycle at 115200 Bd leave 460 Hz at most, the loop runs at 1000 Hz");
  EXPECT_EQ(problem->allowed,
            "set the drive and driver.baud to 460800 or more, or loop.sampling_period to 0.0022 s or more");
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
