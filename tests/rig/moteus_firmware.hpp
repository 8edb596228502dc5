#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rig/firmware.hpp"

namespace zwidth::test {

/// A moteus of id 1 on its UART, as fw/uart_fdcanusb_micro_server.h of db1a7623 has it: 256 bytes for a line; once a line
/// had a right checksum all need one. Its registers as docs/protocol has them: only a stop leads out of the mode that the
/// watchdog ends in.
class MoteusFirmware : public Firmware {
 public:
  /// `is_adapter`: an fdcanusb stands between (fw/can_manager.cc of f18c1d6): no checksums, flags behind what it receives.
  explicit MoteusFirmware(bool is_adapter = false) : is_adapter_(is_adapter) {}

  /// Before it runs.
  void set(const std::string& name, double value) { numbers_[name] = value; }
  void set_version(int version) { version_ = version; }
  /// Another host's command: 12, zero velocity, or 15, brake. For any thread; 0: none.
  std::atomic<int> mode_of_other_host = 0;

  [[nodiscard]] int baud() const override { return 921600; }

  [[nodiscard]] std::vector<std::string> receive(std::string_view bytes, EmulatedMotor& motor) override {
    std::vector<std::string> answers;
    for (const char c : bytes) {
      if (c != '\n' && c != '\r') {
        line_ += c;
        if (line_.size() >= longest_line) line_.clear();
        continue;
      }
      if (!line_.empty()) process(line_, motor, answers);
      line_.clear();
    }
    return answers;
  }

  void tick(Clock::time_point now, bool is_enabled, EmulatedMotor& motor) override {
    obey_other_host(motor);
    if (!is_enabled || mode_ != position || now - fed_ <= timeout_) return;
    mode_ = timed_out;
    motor.let_go();
  }

  void fail(EmulatedMotor& motor) override {
    mode_ = fault;
    motor.let_go();
  }

 private:
  static constexpr std::size_t longest_line = 254;
  static constexpr int stopped = 0;
  static constexpr int fault = 1;
  static constexpr int position = 10;
  static constexpr int timed_out = 11;

  static unsigned crc_of(std::string_view text) {  // as the document's table-driven one
    constexpr unsigned char table[16] = {0x00, 0x97, 0xb9, 0x2e, 0xe5, 0x72, 0x5c, 0xcb,
                                         0x5d, 0xca, 0xe4, 0x73, 0xb8, 0x2f, 0x01, 0x96};
    unsigned crc = 0;
    for (const char c : text) {
      const auto byte = static_cast<unsigned char>(c);
      crc = table[((crc >> 4U) ^ (byte >> 4U)) & 15U] ^ ((crc << 4U) & 0xffU);
      crc = table[((crc >> 4U) ^ (byte & 15U)) & 15U] ^ ((crc << 4U) & 0xffU);
    }
    return crc;
  }

  void say(std::string text, std::vector<std::string>& answers) const {
    if (has_checksums_) {
      text += ' ';
      text += fmt::format("*{:02X}", crc_of(text));
    }
    answers.push_back(text + "\r\n");
  }

  void process(std::string line, EmulatedMotor& motor, std::vector<std::string>& answers) {
    const auto star = line.rfind('*');
    if (is_adapter_ && star != std::string::npos) return say("ERR unknown flag", answers);
    if (star != std::string::npos && star + 3 == line.size()) {
      const auto stated = static_cast<unsigned>(std::strtoul(line.c_str() + star + 1, nullptr, 16));
      if (stated != crc_of(std::string_view(line).substr(0, star))) return say("ERR checksum", answers);
      has_checksums_ = true;
      line.resize(star);
      while (!line.empty() && line.back() == ' ') line.pop_back();
    } else if (has_checksums_) {
      return say("ERR checksum", answers);
    }
    if (!line.starts_with("can send ")) return say("ERR unknown command", answers);
    const auto space = line.find(' ', 9);
    if (space == std::string::npos) return say("ERR missing data", answers);
    const auto id = static_cast<unsigned>(std::strtoul(line.c_str() + 9, nullptr, 16));
    std::vector<unsigned> bytes;
    for (std::size_t i = space + 1; i + 1 < line.size(); i += 2) {
      bytes.push_back(static_cast<unsigned>(std::strtoul(line.substr(i, 2).c_str(), nullptr, 16)));
    }
    say("OK", answers);
    if ((id & 0x7fU) != 1) return;
    const std::string reply = run(bytes, motor);
    if ((id & 0x8000U) != 0)
      say(is_adapter_ ? "rcv 0100 " + reply + "5050 E B F t1234 f0" : "rcv 00000100 " + reply, answers);
  }

  /// The subframes of a CAN frame; what they ask for, as hexadecimal digits.
  std::string run(const std::vector<unsigned>& bytes, EmulatedMotor& motor) {
    std::map<unsigned, double> written;
    std::string reply;
    for (std::size_t at = 0; at < bytes.size();) {
      const unsigned kind = bytes[at++];
      if (kind == 0x50) continue;
      if (kind == 0x40 || kind == 0x42) {  // the diagnostic stream: what it is told, and what it says
        const unsigned size = at + 1 < bytes.size() ? bytes[at + 1] : 0;
        at += 2;
        if (kind == 0x42) {
          const std::string said = said_.substr(0, size);
          said_.erase(0, said.size());
          reply += fmt::format("4101{:02x}", said.size());
          for (const char c : said) reply += fmt::format("{:02x}", static_cast<unsigned char>(c));
          continue;
        }
        for (unsigned i = 0; i < size && at < bytes.size(); ++i) told_ += static_cast<char>(bytes[at++]);
        if (told_.ends_with('\n')) configure(std::exchange(told_, {}));
        continue;
      }
      const unsigned type = (kind >> 2U) & 3U;
      unsigned count = kind & 3U;
      if (count == 0) count = at < bytes.size() ? bytes[at++] : 0;
      unsigned first = at < bytes.size() ? bytes[at++] : 0;
      if (first >= 0x80 && at < bytes.size()) first = (first & 0x7fU) | bytes[at++] << 7U;
      if ((kind & 0xf0U) == 0x10) {
        reply += fmt::format("{:02x}", 0x20U | (kind & 0x0fU));
        reply += first < 0x80 ? fmt::format("{:02x}", first)
                              : fmt::format("{:02x}{:02x}", (first & 0x7fU) | 0x80U, first >> 7U);
        for (unsigned i = 0; i < count; ++i) reply += value(first + i, type, motor);
        continue;
      }
      const unsigned size = type == 0 ? 1 : type == 1 ? 2 : 4;
      for (unsigned i = 0; i < count && at + size <= bytes.size(); ++i, at += size) {
        std::uint32_t bits = 0;
        for (unsigned k = 0; k < size; ++k) bits |= bytes[at + k] << (8 * k);
        written[first + i] = type == 3   ? static_cast<double>(std::bit_cast<float>(bits))
                             : type == 0 ? static_cast<std::int8_t>(bits)
                                         : static_cast<std::int16_t>(bits);
      }
    }
    if (written.contains(0)) command(written, motor);
    obey_other_host(motor);
    return reply;
  }

  /// Whose commands come at once after any other.
  void obey_other_host(EmulatedMotor& motor) {
    const int other = mode_of_other_host;
    if (other == 0 || mode_ == other) return;
    mode_ = other;
    motor.let_go();
  }

  /// "conf set NAME VALUE", "conf get NAME"
  void configure(const std::string& line) {
    const std::string words = line.substr(0, line.size() - 1);
    const std::string name = words.substr(std::min(words.size(), std::size_t{9}), words.find(' ', 9) - 9);
    const auto found = numbers_.find(name);
    if (found == numbers_.end()) {
      said_ += "ERR unknown\r\n";
    } else if (words.starts_with("conf set ")) {
      found->second = std::atof(words.c_str() + words.rfind(' '));
      said_ += "OK\r\n";
    } else {
      said_ += fmt::format("{:.6f}\r\n", static_cast<float>(found->second));
    }
  }

  void command(std::map<unsigned, double>& written, EmulatedMotor& motor) {
    if (written[0] == stopped) {
      mode_ = stopped;
      motor.idle();
    } else if (written[0] == position && (mode_ == stopped || mode_ == position)) {
      const bool has_gains =
          !written.contains(0x23) || !written.contains(0x24) || written[0x23] != 0 || written[0x24] != 0;
      if (has_gains && !has_damper_alone(written)) return fail(motor);  // the position of a rig's torque must not pull
      if (has_gains) motor.set_damping(numbers_["servo.pid_position.kd"] / (2.0 * std::numbers::pi));
      mode_ = position;
      fed_ = Clock::now();
      const double timeout = written.contains(0x27) ? written[0x27] : 0.1;
      timeout_ = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout));
      motor.set_torque(written[0x22]);
    }
  }

  /// No position, velocity 0, and no gain of position beside that of velocity.
  [[nodiscard]] bool has_damper_alone(std::map<unsigned, double>& written) {
    constexpr double whole = 127.0;
    return written.contains(0x20) && std::isnan(written[0x20]) && written[0x21] == 0.0 && written[0x23] == whole &&
           written[0x24] == whole && numbers_["servo.pid_position.kp"] == 0.0 &&
           numbers_["servo.pid_position.ki"] == 0.0 && written.contains(0x25);
  }

  [[nodiscard]] std::string value(unsigned which, unsigned type, EmulatedMotor& motor) const {
    const double number = which == 0 ? mode_ : which == 1 ? motor.turns() : 0.0;
    if (which == 0x101 && type == 2) {
      const auto version = static_cast<unsigned>(version_);
      return fmt::format("{:02x}{:02x}{:02x}00", version & 0xffU, version >> 8U & 0xffU, version >> 16U & 0xffU);
    }
    if (type == 0) return fmt::format("{:02x}", static_cast<unsigned>(static_cast<int>(number)) & 0xffU);
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(number));
    return fmt::format("{:02x}{:02x}{:02x}{:02x}", bits & 0xffU, (bits >> 8U) & 0xffU, (bits >> 16U) & 0xffU,
                       bits >> 24U);
  }

  bool is_adapter_;
  std::map<std::string, double> numbers_{{"servo.pid_position.kp", 4.0},  // its defaults
                                         {"servo.pid_position.kd", 0.05},
                                         {"servo.pid_position.ki", 1.0},
                                         {"servo.timeout_mode", 12.0},
                                         {"motor_position.output.source", 0.0},
                                         {"motor_position.sources.0.pll_filter_hz", 0.0}};  // its motor's is the file's
  int version_ = 0x010100;
  std::string told_;
  std::string said_;
  std::string line_;
  bool has_checksums_ = false;
  int mode_ = stopped;
  Clock::duration timeout_{};
  Clock::time_point fed_;
};

}  // namespace zwidth::test
