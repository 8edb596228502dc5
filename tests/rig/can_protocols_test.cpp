// Frames on CAN buses and the lines of their adapters, byte for byte: examples of documents and sources, and what is none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "rig/can_port.hpp"
#include "rig/can_text.hpp"
#include "rig/moteus_protocol.hpp"
#include "rig/odrive_can_protocol.hpp"
#include "rig/vesc_can_port.hpp"
#include "rig/vesc_protocol.hpp"
#include "zwidth/rig/can_frame_time.hpp"

namespace zwidth::rig {
namespace {

CanFrame frame_of(std::uint32_t id, std::string_view bytes, bool is_extended = false) {
  CanFrame frame{.id = id, .is_extended = is_extended, .size = bytes.size()};
  std::ranges::transform(bytes, frame.bytes.begin(), [](char c) { return static_cast<unsigned char>(c); });
  return frame;
}

// Lawicel, CAN232 manual: "t10021133[CR] sends an 11 bit CAN frame with ID=0x100, 2 bytes with the value 0x11 and 0x33".
TEST(Slcan, IsTheDocumentedOne) {
  const CanFrame standard = frame_of(0x100, "\x11\x33");
  EXPECT_EQ(slcan_line(standard).view(), "t10021133\r");
  EXPECT_EQ(slcan_frame("t10021133\r"), standard);
  const CanFrame extended = frame_of(0x100, "\x11\x33", true);
  EXPECT_EQ(slcan_line(extended).view(), "T0000010021133\r");
  EXPECT_EQ(slcan_frame("T0000010021133"), extended);
  CanFrame remote{.id = 0x100, .is_remote = true, .size = 2};
  EXPECT_EQ(slcan_line(remote).view(), "r1002\r");
  EXPECT_EQ(slcan_frame("r1002\r"), remote);
  remote.is_extended = true;
  EXPECT_EQ(slcan_line(remote).view(), "R000001002\r");
  EXPECT_EQ(slcan_frame("R000001002"), remote);
  EXPECT_EQ(slcan_frame("t0200"), frame_of(0x20, "")) << "the manual's second";
}

// normaldotcom/canable2-fw, README: A is 16 bytes, b a standard identifier with its rate switched, B an extended one.
TEST(Slcan, CarriesCanFd) {
  const auto order = fdcanusb_order("can send 8001 01000a07206000200150ff140400130d");  // moteus, docs/protocol/can.md
  ASSERT_TRUE(order);
  EXPECT_EQ(slcan_line(*order).view(), "B00008001A01000A07206000200150FF140400130D\r");
  const auto torque = fdcanusb_order(std::string(moteus_torque(1, 1.5, 0.1).view()) + "\n");
  ASSERT_TRUE(torque);
  EXPECT_EQ(slcan_line(*torque).view(), "b001B01000A0D220000C03F022300000D27CDCCCC3D50\r") << "19 bytes, filled to 20";
  const auto reply = slcan_frame("b100A2404000A005000000170FF230D181400");
  ASSERT_TRUE(reply);
  EXPECT_TRUE(reply->is_fd);
  const auto values = moteus_reply(fdcanusb_report(*reply).view().substr(0, 40), 1);
  ASSERT_TRUE(values);
  EXPECT_EQ(values->mode, 10);
  EXPECT_NEAR(*values->position, 0.0080, 1e-15);
}

// mjbots/fdcanusb, README: rcv, identifier, data, flags.
TEST(Fdcanusb, IsTheDocumentedOne) {
  EXPECT_EQ(fdcanusb_line(odrive_question(0, OdriveMessage::encoder_estimates)).view(),
            "can std 009 0000000000000000 bfR\n");
  EXPECT_EQ(fdcanusb_line(frame_of(0x117, std::string_view("\0\0\xc7\x38", 4), true)).view(),
            "can ext 00000117 0000C738 bfr\n");
  const auto frame = fdcanusb_frame("rcv 0009 0000A03F00000000 e b f r x-1\r\n");
  ASSERT_TRUE(frame);
  EXPECT_EQ(odrive_message(*frame, 0), OdriveMessage::encoder_estimates);
  EXPECT_EQ(odrive_position(*frame), 1.25);
  const auto bare = fdcanusb_frame("rcv 100 2404000a005000000170ff230d181400");
  ASSERT_TRUE(bare);
  EXPECT_TRUE(bare->is_fd) << "of a moteus, which says no flags";
  EXPECT_FALSE(fdcanusb_frame("OK"));
  EXPECT_FALSE(fdcanusb_frame("rcv 100 240"));
  EXPECT_FALSE(fdcanusb_order("can send 8001"));
  EXPECT_FALSE(fdcanusb_order("tel stop"));
}

TEST(CanText, ReadsWhatItWrites) {
  std::mt19937_64 engine(1);
  const auto drawn = [&](std::uint32_t most) { return std::uniform_int_distribution<std::uint32_t>(0, most)(engine); };
  for (int i = 0; i < 2000; ++i) {
    CanFrame frame;
    frame.is_extended = drawn(1) == 1;
    frame.id = drawn(frame.is_extended ? 0x1fffffff : 0x7ff);
    frame.is_fd = drawn(2) == 0;
    frame.size = *can_fd_size(drawn(frame.is_fd ? 64 : 8));
    frame.is_remote = !frame.is_fd && drawn(3) == 0;
    for (std::size_t k = 0; k < frame.data().size(); ++k) frame.bytes.at(k) = static_cast<unsigned char>(drawn(255));
    EXPECT_EQ(slcan_frame(slcan_line(frame).view()), frame);
    if (frame.size > 0) {
      EXPECT_EQ(fdcanusb_order(fdcanusb_line(frame).view()), frame);
    }
    if (!frame.is_remote && frame.size > 0) {
      EXPECT_EQ(fdcanusb_frame(fdcanusb_report(frame).view()), frame);
    }
    const std::string line(slcan_line(frame).view());
    for (std::size_t size = 0; size + 1 < line.size(); ++size) EXPECT_FALSE(slcan_frame(line.substr(0, size))) << line;
    EXPECT_FALSE(slcan_frame(line.substr(0, line.size() - 1) + "0\r"));
  }
}

TEST(CanText, NoFrameIsReadFromWhatIsNone) {
  for (const std::string_view line :
       {"", "z", "Z", "\a", "t", "t10", "t100", "t1009112233445566778899", "t800", "T2000000001", "T200000000", "b1009",
        "r100F", "t1002113g", "V1013", "b158aa7 github.com/normaldotcom/canable2.git"}) {
    EXPECT_FALSE(slcan_frame(line)) << line;
  }
}

// odriverobotics/ODrive fw-v0.5.6: docs/can-guide.rst shows heartbeats; docs/can-protocol.rst: node << 5 | command.
TEST(OdriveCan, IsThatOfItsDocuments) {
  const CanFrame idle = frame_of(0x001, std::string_view("\0\0\0\0\x01\0\0\0", 8));
  const CanFrame closed = frame_of(0x021, std::string_view("\0\0\0\0\x08\0\0\0", 8));
  ASSERT_EQ(odrive_message(idle, 0), OdriveMessage::heartbeat);
  ASSERT_EQ(odrive_message(closed, 1), OdriveMessage::heartbeat);
  EXPECT_FALSE(odrive_message(closed, 0)) << "of the other axis";
  EXPECT_EQ(odrive_heartbeat(idle).state, 1U);
  EXPECT_EQ(odrive_heartbeat(closed).state, 8U);
  // 0.5.6: error 0x800 of the watchdog; controller flag and trajectory done in byte 7.
  const OdriveHeartbeat bitten = odrive_heartbeat(frame_of(0x001, std::string_view("\0\x08\0\0\x01\0\0\x80", 8)));
  EXPECT_EQ(bitten.error, 0x800U);
  EXPECT_EQ(bitten.state, 1U);
  // 0.6: the watchdog is bit 24 (ODriveEnums.h), procedure result in byte 5.
  EXPECT_EQ(odrive_heartbeat(frame_of(0x001, std::string_view("\0\0\0\x01\x01\x03\0\0", 8))).error, 0x1000000U);
  EXPECT_EQ(slcan_line(odrive_question(1, OdriveMessage::encoder_estimates)).view(), "r0298\r");
  EXPECT_EQ(slcan_line(odrive_state(0, 8)).view(), "t007408000000\r") << "ODriveResources, can_simple.py";
  EXPECT_EQ(slcan_line(odrive_torque_mode(3)).view(), "t06B80100000001000000\r");
  EXPECT_EQ(slcan_line(odrive_input_torque(0, 1.5)).view(), "t00E40000C03F\r");
  EXPECT_EQ(slcan_line(odrive_clear_errors(0)).view(), "t018100\r") << "can_simple_utils.py: 0x18, 00";
  const OdriveVersion version = odrive_version(frame_of(0x000, std::string_view("\x02\x04\x04\x3a\0\x06\x0a\0", 8)));
  EXPECT_EQ(version.major, 0U);
  EXPECT_EQ(version.minor, 6U);
  EXPECT_TRUE(std::isnan(odrive_position(frame_of(9, std::string_view("\0\0\xc0\x7f\0\0\0\0", 8)))));
}

/// A bus whose frames are here.
struct Frames : CanBus {
  std::vector<CanFrame> sent;
  std::deque<CanFrame> coming;
  bool send(const CanFrame& frame) noexcept override {
    sent.push_back(frame);
    return true;
  }
  [[nodiscard]] std::optional<CanFrame> receive(std::int64_t /*until*/) noexcept override {
    if (coming.empty()) return std::nullopt;
    const CanFrame frame = coming.front();
    coming.pop_front();
    return frame;
  }
  [[nodiscard]] bool is_gone() const noexcept override { return false; }
  void drop_unsent() noexcept override {}
};

std::string read_all(BytePort& port) {
  std::string all;
  std::array<char, 7> bytes{};  // fewer than any frame says
  for (auto count = port.read(bytes, 0); count > 0; count = port.read(bytes, 0)) {
    all.append(bytes.data(), static_cast<std::size_t>(count));
  }
  return all;
}

// vedderb/bldc, documentation/comm_can.md: 51 A to VESC 23 is 0x0117, 00 00 C7 38.
TEST(VescCan, IsThatOfItsDocumentAndSources) {
  auto owned = std::make_unique<Frames>();
  Frames& bus = *owned;
  VescCanPort port(std::move(owned), 23);
  ASSERT_TRUE(port.write(vesc_current(51.0).view()));
  ASSERT_TRUE(port.write(vesc_question().view()));
  ASSERT_EQ(bus.sent.size(), 2U);
  EXPECT_EQ(slcan_line(bus.sent[0]).view(), "T0000011740000C738\r");
  // comm_can.c, comm_can_send_buffer(): who asks (254), 0, and the payload in one frame of command 8.
  EXPECT_EQ(slcan_line(bus.sent[1]).view(), "T000008177FE003200218000\r");
  // Its answer, by hand from the same: frames of command 5 with their offset, one of command 7 with length and CRC.
  const std::string payload("\x32\x00\x21\x80\x00\x00\x05\x5d\x4a\x80\x00", 11);
  const std::string packet(vesc_packet(payload).view());
  const auto answer = [&](const std::string& crc) {
    bus.coming.push_back(frame_of(0x5fe, std::string(1, '\0') + payload.substr(0, 7), true));
    bus.coming.push_back(frame_of(0x917, std::string(8, 'x'), true));  // its status, to nobody
    bus.coming.push_back(frame_of(0x5fe, std::string(1, '\x07') + payload.substr(7), true));
    bus.coming.push_back(frame_of(0x7fe, std::string("\x17\x01\x00\x0b", 4) + crc, true));
    return read_all(port);
  };
  const std::string crc = packet.substr(packet.size() - 3, 2);
  EXPECT_EQ(answer(crc), packet);
  EXPECT_FALSE(vesc_payload(answer("ab"))) << "with another CRC it is none";
  bus.coming.push_back(frame_of(0x5fe, std::string(1, '\x07') + payload.substr(7), true));  // the first was lost
  bus.coming.push_back(frame_of(0x7fe, std::string("\x17\x01\x00\x0b", 4) + crc, true));
  EXPECT_EQ(read_all(port), "");
  EXPECT_EQ(answer(crc), packet) << "and the next is whole";
  bus.coming.push_back(frame_of(0x8fe, std::string("\x17\x01\x32\x00\x20\x00\x00\x00", 8), true));
  const std::string mark = read_all(port);
  ASSERT_TRUE(vesc_payload(mark));
  EXPECT_TRUE(is_vesc_mark(*vesc_payload(mark)));
  bus.coming.push_back(frame_of(0x8fe, std::string("\x18\x01\x32\x00\x20\x00\x00\x00", 8), true));
  EXPECT_EQ(read_all(port), "") << "of another VESC";
}

TEST(CanPort, IsAnFdcanusbOnAnyBus) {
  auto owned = std::make_unique<Frames>();
  Frames& bus = *owned;
  CanLinePort port(std::move(owned));
  EXPECT_TRUE(port.write("can send 0001 010000\ncan std 00E 0000C03F bfr\n"));
  ASSERT_EQ(bus.sent.size(), 2U);
  EXPECT_EQ(slcan_line(bus.sent[0]).view(), "b0013010000\r");
  EXPECT_EQ(slcan_line(bus.sent[1]).view(), "t00E40000C03F\r");
  EXPECT_FALSE(port.write("can send 0001 01000\n")) << "half a byte";
  bus.coming.push_back(bus.sent[1]);
  EXPECT_EQ(read_all(port), "rcv 00E 0000C03F e b f r\n");
}

// Davis and others, equation (1): 80 + 10 n bits with an extended identifier, 55 + 10 n with a standard one, in whole steps.
TEST(CanFrameTime, IsTheLongestWithStuffedBits) {
  const CanBitRates fast{1e6, 0.0};
  for (unsigned n = 0; n <= 8; ++n) {
    EXPECT_NEAR(can_frame_time({n}, fast), 1e-6 * (55 + 10 * n), 1e-15) << n;
    EXPECT_NEAR(can_frame_time({n, true}, fast), 1e-6 * (80 + 10 * n), 1e-15) << n;
  }
  EXPECT_NEAR(can_frame_time({8, false, true}, fast), 55e-6, 1e-15) << "a question has no data";
  EXPECT_NEAR(can_frame_time({8}, {250e3, 0.0}), 4.0 * 135e-6, 1e-15);
  // By hand: 17 + 4 + 12 bits at 1 Mbit/s; 5 + 8 16 and their 34 stuffed, 4 + 17 and 6 fixed ones, a delimiter at 5 Mbit/s.
  EXPECT_NEAR(can_frame_time({16, false, false, true}, {1e6, 5e6}), 33e-6 + 195e-6 / 5.0, 1e-15);
  EXPECT_GT(can_frame_time({20, true, false, true}, {1e6, 5e6}), can_frame_time({20, false, false, true}, {1e6, 5e6}));
}

TEST(CanAdapter, IsAPortOrAnInterface) {
  EXPECT_EQ(can_adapter("/dev/ttyACM0")->baud, 4'000'000);
  EXPECT_EQ(can_adapter("/dev/ttyUSB0@115200")->place, "/dev/ttyUSB0");
  EXPECT_EQ(can_adapter("/dev/ttyUSB0@115200")->baud, 115200);
  EXPECT_EQ(can_adapter("can0")->place, "can0");
  EXPECT_FALSE(can_adapter("can0")->baud);
  for (const std::string_view name :
       {"", "@", "@115200", "/dev/ttyUSB0@", "/dev/ttyUSB0@fast", "/dev/ttyUSB0@-1", "can0@5"}) {
    EXPECT_FALSE(can_adapter(name)) << name;
  }
}

}  // namespace
}  // namespace zwidth::rig
