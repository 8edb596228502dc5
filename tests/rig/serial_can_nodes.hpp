#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "rig/can_node.hpp"
#include "rig/moteus_firmware.hpp"
#include "rig/vesc_firmware.hpp"

namespace zwidth::test {

/// A moteus on CAN FD: what its UART takes as text, in frames (docs/protocol/can.md): 0x8001 asks id 1 for an answer, which
/// comes as 0x100.
class MoteusCanNode : public CanNode {
 public:
  [[nodiscard]] int bitrate() const override { return 1'000'000; }

  [[nodiscard]] std::vector<rig::CanFrame> hear(const rig::CanFrame& frame, EmulatedMotor& motor) override {
    if (!frame.is_fd) return {};
    std::string line = fmt::format("can send {:x} ", frame.id);
    for (const unsigned char each : frame.data()) line += fmt::format("{:02x}", each);
    std::vector<rig::CanFrame> frames;
    for (const std::string& answer : firmware_.receive(line + "\n", motor)) {
      if (!answer.starts_with("rcv ")) continue;
      rig::CanFrame reply{.id = 0x100, .is_fd = true};
      const std::string digits = answer.substr(9, answer.find(' ', 9) - 9);
      for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
        reply.bytes.at(reply.size++) =
            static_cast<unsigned char>(std::strtoul(digits.substr(i, 2).c_str(), nullptr, 16));
      }
      while (rig::can_fd_size(reply.size) != reply.size) reply.bytes.at(reply.size++) = 0x50;
      frames.push_back(reply);
    }
    return frames;
  }
  void tick(Clock::time_point now, bool is_enabled, EmulatedMotor& motor) override {
    firmware_.tick(now, is_enabled, motor);
  }
  void fail(EmulatedMotor& motor) override { firmware_.fail(motor); }

 private:
  MoteusFirmware firmware_{true};
};

/// A VESC of id 23 on CAN, as comm/comm_can.c of b9d287b3 has it: decode_msg() and comm_can_send_buffer() around the
/// commands that its UART takes, too.
class VescCanNode : public CanNode {
 public:
  VescCanNode() = default;
  explicit VescCanNode(const VescFirmware::Settings& settings) : firmware_(settings) {}

  static constexpr unsigned id = 23;

  [[nodiscard]] int bitrate() const override { return 500'000; }

  [[nodiscard]] std::vector<rig::CanFrame> hear(const rig::CanFrame& frame, EmulatedMotor& motor) override {
    if (!frame.is_extended || frame.is_fd || (frame.id & 0xffU) != id) return {};
    const std::string data(reinterpret_cast<const char*>(frame.bytes.data()), frame.data().size());
    std::vector<rig::CanFrame> frames;
    switch (frame.id >> 8U) {
      case 1:  // CAN_PACKET_SET_CURRENT
        (void)firmware_.receive(VescFirmware::packet(std::string(1, 6) + data), motor);
        return {};
      case 8:  // CAN_PACKET_PROCESS_SHORT_BUFFER: who asks, what for, payload
        if (data.size() < 3 || data[1] != 0) return {};
        for (const std::string& packet : firmware_.receive(VescFirmware::packet(data.substr(2)), motor)) {
          const std::size_t head = packet[0] == 3 ? 3 : 2;
          send_buffer(static_cast<unsigned char>(data[0]), packet.substr(head, packet.size() - head - 3),
                      packet.substr(packet.size() - 3, 2), frames);
        }
        return frames;
      default:
        return {};
    }
  }
  [[nodiscard]] std::vector<rig::CanFrame> unasked(Clock::time_point now, EmulatedMotor& /*motor*/) override {
    if (now - told_ < std::chrono::milliseconds(20)) return {};
    told_ = now;  // CAN_PACKET_STATUS, to nobody
    return {frame_of(9U << 8U | id, std::string(8, '\0'))};
  }
  void tick(Clock::time_point now, bool is_enabled, EmulatedMotor& motor) override {
    firmware_.tick(now, is_enabled, motor);
  }
  void fail(EmulatedMotor& motor) override { firmware_.fail(motor); }

 private:
  static rig::CanFrame frame_of(unsigned identifier, std::string_view data) {
    rig::CanFrame frame{.id = identifier, .is_extended = true, .size = data.size()};
    for (std::size_t i = 0; i < data.size(); ++i) frame.bytes[i] = static_cast<unsigned char>(data[i]);
    return frame;
  }
  static void send_buffer(unsigned to, const std::string& payload, const std::string& crc,
                          std::vector<rig::CanFrame>& frames) {
    const std::string head{static_cast<char>(id), 1};
    if (payload.size() <= 6) {
      frames.push_back(frame_of(8U << 8U | to, head + payload));
      return;
    }
    std::size_t at = 0;
    for (; at < payload.size() && at <= 255; at += 7) {
      frames.push_back(frame_of(5U << 8U | to, std::string(1, static_cast<char>(at)) + payload.substr(at, 7)));
    }
    for (; at < payload.size(); at += 6) {
      const std::string offset{static_cast<char>(at >> 8U), static_cast<char>(at)};
      frames.push_back(frame_of(6U << 8U | to, offset + payload.substr(at, 6)));
    }
    const std::string length{static_cast<char>(payload.size() >> 8U), static_cast<char>(payload.size())};
    frames.push_back(frame_of(7U << 8U | to, head + length + crc));
  }

  VescFirmware firmware_;
  Clock::time_point told_;
};

}  // namespace zwidth::test
