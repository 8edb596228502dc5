#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rig/firmware.hpp"

namespace zwidth::test {

/// A VESC on its UART, as comm/packet.c and comm/commands.c of b9d287b3 have it: what is no packet is skipped byte by byte;
/// every SET feeds the watchdog (timeout.c, here set to 100 ms), which looks every 10 ms. Settings as confgenerator.c orders them.
class VescFirmware : public Firmware {
 public:
  /// Before it runs. A minimum current of 0.05 A, the firmware's default, is much on the belt of the tests.
  struct Settings {
    int major = 6;
    int minor = 6;
    std::uint32_t signature = 788332866;  // MCCONF_SIGNATURE of 6.06
    double angle_division = 1.0;
    double least_current = 0.0;
  };
  VescFirmware() = default;
  explicit VescFirmware(const Settings& settings) : settings_(settings) {}

  [[nodiscard]] int baud() const override { return 115200; }

  [[nodiscard]] std::vector<std::string> receive(std::string_view bytes, EmulatedMotor& motor) override {
    std::vector<std::string> answers;
    buffer_ += bytes;
    while (!buffer_.empty()) {
      const auto length = buffer_.size() > 1 ? static_cast<unsigned char>(buffer_[1]) : 1U;
      if (buffer_[0] != 2 || length == 0) {
        buffer_.erase(0, 1);
      } else if (buffer_.size() < length + 5) {
        break;
      } else if (buffer_[length + 4] != 3 || crc_of(buffer_.substr(2, length)) != big_endian(2 + length, 2)) {
        buffer_.erase(0, 1);
      } else {
        process(buffer_.substr(2, length), motor, answers);
        buffer_.erase(0, length + 5);
      }
    }
    return answers;
  }

  void tick(Clock::time_point now, bool is_enabled, EmulatedMotor& motor) override {
    if (now - looked_ < std::chrono::milliseconds(10)) return;
    looked_ = now;
    const bool is_late = is_enabled && now - fed_ > std::chrono::milliseconds(100);
    if (is_late && !has_timeout_ && fed_ != Clock::time_point{}) motor.let_go();
    has_timeout_ = is_late;
  }

  void fail(EmulatedMotor& motor) override {
    fault_ = 4;  // FAULT_CODE_ABS_OVER_CURRENT
    motor.let_go();
  }

  static std::string packet(const std::string& payload) {
    const unsigned crc = crc_of(payload);
    std::string packet{2, static_cast<char>(payload.size())};
    if (payload.size() > 255) packet = {3, static_cast<char>(payload.size() >> 8U), static_cast<char>(payload.size())};
    packet += payload;
    packet += {static_cast<char>(crc >> 8U), static_cast<char>(crc), 3};
    return packet;
  }

 private:
  static unsigned crc_of(std::string_view payload) {
    unsigned crc = 0;
    for (const char c : payload) {
      crc ^= static_cast<unsigned>(static_cast<unsigned char>(c)) << 8U;
      for (int bit = 0; bit < 8; ++bit) crc = (crc << 1U ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U)) & 0xffffU;
    }
    return crc;
  }
  [[nodiscard]] std::uint32_t big_endian(std::size_t at, std::size_t size) const {
    return big_endian(buffer_, at, size);
  }
  static std::uint32_t big_endian(std::string_view bytes, std::size_t at, std::size_t size) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
    return value;
  }
  static void place(std::string& bytes, std::size_t at, std::uint32_t value) {
    std::string text;
    append(text, value);
    bytes.replace(at, text.size(), text);
  }
  static void append(std::string& bytes, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> static_cast<unsigned>(shift));
  }

  void process(std::string_view payload, EmulatedMotor& motor, std::vector<std::string>& answers) {
    const unsigned command = static_cast<unsigned char>(payload[0]);
    if (command == 6 && payload.size() >= 5) {  // COMM_SET_CURRENT
      const double amperes = static_cast<std::int32_t>(big_endian(payload, 1, 4)) / 1000.0;
      fed_ = Clock::now();
      const bool is_cut = std::abs(amperes) < settings_.least_current;  // mcpwm_foc_set_current()
      if (fault_ == 0) motor.set_torque(is_cut ? 0.0 : amperes * motor.drive().torque_constant.value());
    } else if (command == 0) {  // COMM_FW_VERSION: with the board's name, its number and some flags
      std::string reply{0, static_cast<char>(settings_.major), static_cast<char>(settings_.minor)};
      answers.push_back(packet(reply + std::string("60_MK6\0", 7) + std::string(20, '\0')));
    } else if (command == 14) {  // COMM_GET_MCCONF
      std::string settings(483, '\0');
      place(settings, 0, settings_.signature);
      place(settings, 367, std::bit_cast<std::uint32_t>(static_cast<float>(settings_.angle_division)));
      place(settings, 379, std::bit_cast<std::uint32_t>(static_cast<float>(settings_.least_current)));
      answers.push_back(packet(std::string(1, 14) + settings));
    } else if (command == 50 && payload.size() >= 5) {  // COMM_GET_VALUES_SELECTIVE
      const std::uint32_t mask = big_endian(payload, 1, 4);
      std::string reply(1, 50);
      append(reply, mask);
      if ((mask >> 15U & 1U) != 0) reply += static_cast<char>(fault_);
      if ((mask >> 16U & 1U) != 0) {
        const double turns = motor.turns() / settings_.angle_division;
        const double degrees = 360.0 * (turns - std::floor(turns));
        append(reply, static_cast<std::uint32_t>(static_cast<std::int32_t>(degrees * 1e6)));
      }
      if ((mask >> 21U & 1U) != 0 && settings_.major >= 6) reply += static_cast<char>(has_timeout_ ? 1 : 0);
      answers.push_back(packet(reply));
    }
  }

  Settings settings_;
  std::string buffer_;
  int fault_ = 0;
  bool has_timeout_ = true;
  Clock::time_point fed_;
  Clock::time_point looked_;
};

}  // namespace zwidth::test
