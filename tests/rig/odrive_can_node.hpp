#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "rig/can_node.hpp"

namespace zwidth::test {

/// Axis 0 of an ODrive on CAN: 0.5 as Firmware/communication/can/can_simple.cpp of fw-v0.5.6 has it, where any frame feeds
/// the watchdog; 0.6 as can_simple_messages.hpp of odriverobotics/ODriveArduino has it, where setpoints alone do.
class OdriveCanNode : public CanNode {
 public:
  explicit OdriveCanNode(int minor = 5) : minor_(minor) {}

  [[nodiscard]] int bitrate() const override { return 250'000; }

  [[nodiscard]] std::vector<rig::CanFrame> hear(const rig::CanFrame& frame, EmulatedMotor& motor) override {
    if (frame.is_extended || frame.is_fd || frame.id >> 5U != 0) return {};
    const std::uint32_t command = frame.id & 31U;
    if (minor_ == 5 || (command >= 12 && command <= 14)) fed_ = Clock::now();
    switch (command) {
      case 0x00:
        if (minor_ == 5 || !frame.is_remote) return {};
        return {from_axis(0, 0x03040602, 0x00000600)};  // protocol 2, hardware 6.4.3; firmware 0.6.0
      case 0x07:
        request(at(frame, 0), motor);
        return {};
      case 0x09:
        if (!frame.is_remote && frame.size != 0) return {};
        return {estimates(motor)};
      case 0x0b:
        is_torque_ = at(frame, 0) == 1 && at(frame, 4) == 1;
        return {};
      case 0x0e:
        if (state_ == closed_loop && is_torque_) {
          motor.set_torque(static_cast<double>(std::bit_cast<float>(at(frame, 0))));
        }
        return {};
      case 0x17:
        if (!frame.is_remote && frame.size != 0) return {};
        return {from_axis(0x17, std::bit_cast<std::uint32_t>(24.087744F), 0)};
      case 0x18:
        error_ = 0;
        return {};
      default:
        return {};
    }
  }

  [[nodiscard]] std::vector<rig::CanFrame> unasked(Clock::time_point now, EmulatedMotor& motor) override {
    std::vector<rig::CanFrame> frames;
    if (now - beat_ >= std::chrono::milliseconds(100)) {
      beat_ = now;
      frames.push_back(from_axis(1, error_, static_cast<std::uint32_t>(state_)));
    }
    if (encoder_rate.count() > 0 && now - told_ >= encoder_rate) {
      told_ = now;
      frames.push_back(estimates(motor));
    }
    return frames;
  }

  void tick(Clock::time_point now, bool is_enabled, EmulatedMotor& motor) override {
    if (!is_enabled || now - fed_ <= std::chrono::milliseconds(100)) return;
    error_ |= minor_ == 5 ? 0x800U : 0x1000000U;  // in any state
    if (state_ == closed_loop) motor.let_go();
    state_ = idle;
  }

  void fail(EmulatedMotor& motor) override {
    error_ |= 0x40;
    state_ = idle;
    motor.let_go();
  }

  std::chrono::milliseconds encoder_rate{0};  ///< encoder_rate_ms, which is 10 by default

 private:
  static constexpr int idle = 1;
  static constexpr int closed_loop = 8;

  static std::uint32_t at(const rig::CanFrame& frame, std::size_t first) {
    return frame.bytes[first] | static_cast<std::uint32_t>(frame.bytes[first + 1]) << 8U |
           static_cast<std::uint32_t>(frame.bytes[first + 2]) << 16U |
           static_cast<std::uint32_t>(frame.bytes[first + 3]) << 24U;
  }
  static rig::CanFrame from_axis(std::uint32_t command, std::uint32_t low, std::uint32_t high) {
    rig::CanFrame frame{.id = command, .size = 8};
    for (unsigned i = 0; i < 4; ++i) {
      frame.bytes[i] = static_cast<unsigned char>(low >> (8 * i));
      frame.bytes[4 + i] = static_cast<unsigned char>(high >> (8 * i));
    }
    return frame;
  }
  static rig::CanFrame estimates(EmulatedMotor& motor) {
    return from_axis(9, std::bit_cast<std::uint32_t>(static_cast<float>(motor.turns())), 0);
  }

  void request(std::uint32_t state, EmulatedMotor& motor) {
    state_ = error_ == 0 && state == closed_loop ? closed_loop : idle;
    fed_ = Clock::now();
    if (state_ == idle) motor.idle();
  }

  int minor_;
  std::uint32_t error_ = 0;
  int state_ = idle;
  bool is_torque_ = false;
  Clock::time_point fed_ = Clock::now();
  Clock::time_point beat_;
  Clock::time_point told_;
};

}  // namespace zwidth::test
