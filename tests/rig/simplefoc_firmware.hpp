#pragma once

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "rig/firmware.hpp"

namespace zwidth::test {

/// A sketch with motor "M" in SimpleFOC's Commander, as src/communication/Commander.cpp of v2.3.4 has it: a buffer of 20
/// characters, which starts afresh where a line is longer; what it answers by its verbosity and decimals. No watchdog, unless
/// the sketch has a timeout.
class SimplefocFirmware : public Firmware {
 public:
  explicit SimplefocFirmware(std::string torque = "foc curr", double phase_resistance = 0.0,
                             std::chrono::milliseconds timeout = {})
      : torque_(std::move(torque)), phase_resistance_(phase_resistance), timeout_(timeout) {}

  double angle_lag = 0.0;  ///< s, LPF_angle.Tf, which it tells; its motor's position is that of the file

  [[nodiscard]] int baud() const override { return 115200; }

  [[nodiscard]] std::vector<std::string> receive(std::string_view bytes, EmulatedMotor& motor) override {
    std::vector<std::string> answers;
    heard_ = Clock::now();
    for (const char c : bytes) {
      received_.at(count_++) = c;
      if (c == '\n' || c == '\r') {
        if (std::string text = run(received_.data(), motor); !text.empty()) answers.push_back(std::move(text));
        received_[0] = '\0';
        count_ = 0;
      }
      if (count_ >= received_.size()) {
        received_[0] = '\0';
        count_ = 0;
      }
    }
    return answers;
  }

  void tick(Clock::time_point now, bool is_enabled, EmulatedMotor& motor) override {
    if (is_enabled && is_enabled_ && timeout_.count() > 0 && now - heard_ > timeout_) fail(motor);
  }
  void fail(EmulatedMotor& motor) override {
    is_enabled_ = false;
    motor.let_go();
  }

 private:
  static bool is_sentinel(char c) { return c == '\n' || c == '\r'; }
  [[nodiscard]] std::string echo(std::string_view text) const { return is_for_machines_ ? std::string(text) : ""; }
  [[nodiscard]] std::string number(double value) const {
    return fmt::format("{:.{}f}\r\n", static_cast<float>(value), decimals_);
  }

  std::string run(const char* input, EmulatedMotor& motor) {
    switch (input[0]) {
      case '@':
        if (!is_sentinel(input[1])) is_for_machines_ = std::atoi(input + 1) == 3;
        return echo("@") + "machine\r\n";
      case '#':
        if (!is_sentinel(input[1])) decimals_ = std::atoi(input + 1);
        return echo("#") + fmt::format("{}\r\n", decimals_);
      case 'M':
        return echo("M") + command(input + 1, motor);
      default:
        return "";
    }
  }

  std::string command(const char* input, EmulatedMotor& motor) {
    const char c = input[0];
    if ((c >= '0' && c <= '9') || c == '-' || c == '+') {
      target_ = std::strtof(input, nullptr);
      apply(motor);
      return number(static_cast<double>(target_));
    }
    switch (c) {
      case 'M':
        if (input[1] == 'G' && input[2] == '6') {
          return echo("MG") + number(2.0 * std::numbers::pi * motor.turns());
        }
        return echo("M") + "err\r\n";
      case 'T':
        return echo("T") + torque_ + "\r\n";
      case 'R':
        return echo("R") + number(phase_resistance_);
      case 'C':
        if (!is_sentinel(input[1])) motion_ = std::atoi(input + 1);
        return echo("C") + (motion_ == torque_motion     ? "torque\r\n"
                            : motion_ == velocity_motion ? "vel\r\n"
                                                         : "angle\r\n");
      case 'V': {
        const auto found = velocity_.find(input[1]);
        if (found == velocity_.end()) return echo("V") + "err\r\n";
        if (!is_sentinel(input[2])) found->second = std::atof(input + 2);
        return echo(std::string("V") + input[1]) + number(found->second);
      }
      case 'A':
        if (input[1] != 'F') return echo("A") + "err\r\n";
        return echo("AF") + number(angle_lag);
      case 'L':
        if (input[1] != 'U' && input[1] != 'C') return echo(std::string_view(input, 2)) + "err\r\n";
        return echo(std::string_view(input, 2)) + number(input[1] == 'U' ? voltage_limit : current_limit);
      case 'E':
        if (!is_sentinel(input[1])) is_enabled_ = std::atoi(input + 1) != 0;
        if (!is_enabled_) motor.idle();
        return echo("E") + (is_enabled_ ? "1\r\n" : "0\r\n");
      default:
        return echo(std::string_view(&c, 1)) + "err\r\n";
    }
  }

  void apply(EmulatedMotor& motor) const {
    if (!is_enabled_ || motion_ > velocity_motion) return;
    const MotorDrive& drive = motor.drive();
    const double unit = torque_ == "volt" ? drive.torque_per_volt.value() : drive.torque_constant.value();
    if (motion_ == torque_motion) return motor.set_torque(static_cast<double>(target_) * unit);
    if (velocity_.at('I') != 0.0 || velocity_.at('D') != 0.0 || velocity_.at('R') != 0.0) return;  // no damper alone
    const double time_constant = velocity_.at('F');
    const double damping = velocity_.at('P') * unit;
    motor.set_damping(damping, time_constant > 0.0 ? 1.0 / (2.0 * std::numbers::pi * time_constant) : 0.0);
    motor.set_torque(static_cast<double>(target_) * damping);
  }

  std::string torque_;
  double phase_resistance_;
  std::chrono::milliseconds timeout_;  // 0: none
  Clock::time_point heard_ = Clock::now();
  std::array<char, 20> received_{};
  std::size_t count_ = 0;
  bool is_for_machines_ = false;
  int decimals_ = 3;
  static constexpr double voltage_limit = 12.0;
  static constexpr double current_limit = 2.0;
  static constexpr int torque_motion = 0;
  static constexpr int velocity_motion = 1;
  int motion_ = 2;
  std::map<char, double> velocity_{{'P', 0.5}, {'I', 10.0}, {'D', 0.0}, {'R', 1000.0}, {'L', 12.0}, {'F', 0.005}};
  bool is_enabled_ = true;
  float target_ = 0.0F;
};

}  // namespace zwidth::test
