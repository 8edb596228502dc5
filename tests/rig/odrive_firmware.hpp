#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "rig/firmware.hpp"

namespace zwidth::test {

/// ODrive's ASCII protocol on axis 0, as Firmware/communication/ascii_protocol.cpp of fw-v0.5.1 to fw-v0.5.6 has it: lines end with
/// \r, \n or !; a wrong checksum makes a line be ignored, a right one asks for one; `c` feeds the watchdog, `f` does not. Enabled, the
/// watchdog runs in every state. 0.6 by its documentation, for its sources are not public.
class OdriveFirmware : public Firmware {
 public:
  enum class Version {
    v0_5_1,  // no `sc`: errors are cleared by writing them
    v0_5_2,  // an answer with a checksum has no end of its line
    v0_5_6,
    v0_6  // errors have other names and bits, and cannot be written
  };

  explicit OdriveFirmware(Version version = Version::v0_5_6) : version_(version) {
    if (version_ != Version::v0_6) return;
    const std::map<std::string, double> of_0_6{
        {"controller.config.vel_gain", 1.0 / 6.0}, {"controller.config.vel_integrator_gain", 1.0 / 3.0},
        {"config.torque_soft_max", 1e9},           {"config.encoder_bandwidth", untold_bandwidth},
        {"config.motor.current_soft_max", 10.0},   {"config.motor.torque_constant", 0.04}};
    numbers_ = of_0_6;
  }

  /// Before it runs. The velocity limit of torque control, on by default in the firmware, is off here, and does nothing.
  void set(const std::string& name, double value) { numbers_[name] = value; }
  /// For any thread.
  [[nodiscard]] bool has_watchdog() const { return watchdog_is_enabled_; }
  [[nodiscard]] bool has_error() const { return error_ != 0; }
  [[nodiscard]] int baud() const override { return 115200; }

  [[nodiscard]] std::vector<std::string> receive(std::string_view bytes, EmulatedMotor& motor) override {
    std::vector<std::string> answers;
    for (const char c : bytes) {
      if (c == '\r' || c == '\n' || c == '!') {
        if (is_whole_) process(line_, motor, answers);
        line_.clear();
        is_whole_ = true;
      } else if (line_.size() < longest_line) {
        line_ += c;
      } else {
        line_.clear();
        is_whole_ = false;  // until the next end of a line
      }
    }
    return answers;
  }

  void tick(Clock::time_point now, bool is_enabled, EmulatedMotor& motor) override {
    if (!is_enabled || !watchdog_is_enabled_ || now - fed_ <= timeout_) return;
    error_ |= watchdog_expired();
    if (state_ != closed_loop) return;
    state_ = idle;
    motor.let_go();
  }

  void fail(EmulatedMotor& motor) override {
    error_ |= motor_failed;
    state_ = idle;
    motor.let_go();
  }

 private:
  static constexpr long motor_failed = 0x40;
  static constexpr std::size_t longest_line = 256;
  static constexpr int idle = 1;
  static constexpr int closed_loop = 8;
  static constexpr double supply_voltage = 24.087744;
  static constexpr double untold_bandwidth = 1e6;  // rad/s: its motor's position is that of the file; 1000 by default

  [[nodiscard]] long watchdog_expired() const { return version_ == Version::v0_6 ? 0x1000000 : 0x800; }
  [[nodiscard]] std::string error_name() const { return version_ == Version::v0_6 ? "active_errors" : "error"; }

  void process(std::string line, EmulatedMotor& motor, std::vector<std::string>& answers) {
    if (const auto comment = line.find(';'); comment != std::string::npos) line.resize(comment);
    bool has_checksum = false;
    if (const auto star = line.find('*'); star != std::string::npos) {
      unsigned sum = 0;
      for (const char c : line.substr(0, star)) sum ^= static_cast<unsigned char>(c);
      unsigned received = 0;
      if (std::sscanf(line.c_str() + star + 1, "%u", &received) < 1 || received != sum) return;
      has_checksum = true;
      line.resize(star);
    }
    std::string text = answer(line, motor);
    if (text.empty()) return;
    if (has_checksum) {
      unsigned sum = 0;
      for (const char c : text) sum ^= static_cast<unsigned char>(c);
      text += fmt::format("*{}", sum);
    }
    answers.push_back(text + (has_checksum && version_ == Version::v0_5_2 ? "" : "\r\n"));
  }

  std::string answer(const std::string& line, EmulatedMotor& motor) {
    unsigned axis = 0;
    float value = 0.0F;
    switch (line.empty() ? '\0' : line[0]) {
      case 'c':
        if (std::sscanf(line.c_str(), "c %u %f", &axis, &value) < 2) return "invalid command format";
        if (axis > 1) return fmt::format("invalid motor {}", axis);
        fed_ = Clock::now();
        if (state_ == closed_loop) {
          motor.set_torque(static_cast<double>(value));
        }
        return "";
      case 'v': {
        float velocity = 0.0F;
        if (std::sscanf(line.c_str(), "v %u %f %f", &axis, &velocity, &value) < 2) return "invalid command format";
        if (axis > 1) return fmt::format("invalid motor {}", axis);
        fed_ = Clock::now();
        if (state_ != closed_loop) return "";
        if (velocity != 0.0F || numbers_["controller.config.vel_integrator_gain"] != 0.0) {
          fail(motor);  // it would run away
          return "";
        }
        motor.set_damping(numbers_["controller.config.vel_gain"] / (2.0 * std::numbers::pi));
        motor.set_torque(static_cast<double>(value));
        return "";
      }
      case 'f':
        if (std::sscanf(line.c_str(), "f %u", &axis) < 1) return "invalid command format";
        if (axis > 1) return fmt::format("invalid motor {}", axis);
        return fmt::format("{:.6f} {:.6f}", static_cast<float>(motor.turns()), 0.0F);
      case 'r': {
        if (line == "r axis0." + error_name()) return fmt::format("{}", error_.load());
        if (line == "r axis0.config.enable_watchdog") return watchdog_is_enabled_ ? "1" : "0";
        if (line == "r axis0.config.watchdog_timeout") {
          return fmt::format("{:.6f}", std::chrono::duration<double>(timeout_).count());
        }
        if (line == "r axis0.controller.config.control_mode") return fmt::format("{}", control_mode_);
        if (line == "r axis0.controller.config.input_mode") return fmt::format("{}", input_mode_);
        if (line == "r axis0.current_state") return fmt::format("{}", state_);
        if (line == "r vbus_voltage") return fmt::format("{:.6f}", supply_voltage);
        if (const auto found = numbers_.find(line.substr(std::min(line.size(), std::size_t{8})));
            line.starts_with("r axis0.") && found != numbers_.end()) {
          return fmt::format("{:.6f}", static_cast<float>(found->second));
        }
        return "invalid property";
      }
      case 'w':
        return write(line, motor);
      case 's':
        if (line == "sc" && version_ != Version::v0_5_1) error_ = 0;
        return "";
      default:
        return "unknown command";
    }
  }

  std::string write(const std::string& line, EmulatedMotor& motor) {
    const auto space = line.rfind(' ');
    const std::string name = line.substr(0, space);
    const double value = std::atof(line.c_str() + space + 1);
    if (name == "w axis0.config.watchdog_timeout") {
      timeout_ = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(value));
    } else if (name == "w axis0.config.enable_watchdog") {
      watchdog_is_enabled_ = value != 0.0;
    } else if (name == "w axis0.requested_state") {
      state_ = error_ == 0 && static_cast<int>(value) == closed_loop ? closed_loop : idle;
      fed_ = Clock::now();
      if (state_ == idle) motor.idle();
    } else if (const auto found = numbers_.find(name.substr(std::min(name.size(), std::size_t{8})));
               name.starts_with("w axis0.") && found != numbers_.end()) {
      found->second = value;
    } else if (name == "w axis0.controller.config.control_mode") {
      control_mode_ = static_cast<int>(value);
    } else if (name == "w axis0.controller.config.input_mode") {
      input_mode_ = static_cast<int>(value);
    } else if (name == "w axis0.error" && version_ != Version::v0_6) {
      error_ = static_cast<long>(value);
    } else {
      return "invalid property";
    }
    return "";
  }

  std::map<std::string, double> numbers_{{"controller.config.vel_gain", 1.0 / 6.0},  // its defaults
                                         {"controller.config.vel_limit", 2.0},
                                         {"controller.config.enable_torque_mode_vel_limit", 0.0},
                                         {"controller.config.vel_integrator_gain", 1.0 / 3.0},
                                         {"motor.config.torque_lim", 1e9},
                                         {"encoder.config.bandwidth", untold_bandwidth},
                                         {"motor.config.current_lim", 10.0},
                                         {"motor.config.torque_constant", 0.04}};
  Version version_;
  int control_mode_ = 3;  // of positions, its default
  int input_mode_ = 1;
  std::string line_;
  bool is_whole_ = true;
  std::atomic<long> error_ = 0;
  int state_ = idle;
  std::atomic<bool> watchdog_is_enabled_ = false;
  Clock::duration timeout_{};
  Clock::time_point fed_;
};

}  // namespace zwidth::test
