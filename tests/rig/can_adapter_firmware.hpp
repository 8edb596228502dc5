#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rig/can_node.hpp"
#include "rig/firmware.hpp"

namespace zwidth::test {

/// An adapter with a drive on its bus: SLCAN as a CANable 2.0 has it (slcan.c of normaldotcom/canable2-fw), which confirms
/// nothing, or as a Lawicel (CANUSB manual, 2013), which confirms everything; or an fdcanusb (fw/can_manager.cc of f18c1d6).
class CanAdapterFirmware : public Firmware {
 public:
  enum class Kind { canable, lawicel, fdcanusb };

  explicit CanAdapterFirmware(std::unique_ptr<CanNode> node, Kind kind = Kind::canable)
      : node_(std::move(node)),
        kind_(kind),
        bitrate_(kind == Kind::fdcanusb ? 1'000'000 : 0),
        is_open_(kind == Kind::fdcanusb) {}

  [[nodiscard]] int baud() const override { return 4'000'000; }

  [[nodiscard]] std::vector<std::string> receive(std::string_view bytes, EmulatedMotor& motor) override {
    std::vector<std::string> answers;
    for (const char c : bytes) {
      const bool is_end = c == '\r' || (c == '\n' && kind_ == Kind::fdcanusb);
      if (!is_end) {
        line_ += c;
        continue;
      }
      const std::string line = std::exchange(line_, {});
      if (kind_ == Kind::fdcanusb) {
        if (!line.empty()) fdcanusb(line, motor, answers);
      } else {
        slcan(line, motor, answers);
      }
    }
    return answers;
  }

  [[nodiscard]] std::vector<std::string> unasked(EmulatedMotor& motor) override {
    std::vector<std::string> lines;
    for (const rig::CanFrame& each : node_->unasked(Clock::now(), motor)) hand_on(each, lines);
    return lines;
  }

  /// On the line, and on the bus at 1.25 of its bits, for those that are stuffed.
  [[nodiscard]] double time_on_wire(std::string_view bytes, int baud) const override {
    double bus = 0.0;
    for (std::string_view rest = bytes; !rest.empty();) {
      const std::string line(rest.substr(0, rest.find_first_of("\r\n")));
      rest.remove_prefix(std::min(rest.size(), line.size() + 1));
      const auto frame = kind_ == Kind::fdcanusb ? std::optional<rig::CanFrame>() : parsed(line);
      if (frame && bitrate_ > 0) bus += 1.25 * (47.0 + 8.0 * static_cast<double>(frame->data().size())) / bitrate_;
    }
    return 10.0 * static_cast<double>(bytes.size()) / baud + bus;
  }

  void tick(Clock::time_point now, bool is_enabled, EmulatedMotor& motor) override {
    node_->tick(now, is_enabled, motor);
  }
  void fail(EmulatedMotor& motor) override { node_->fail(motor); }

 private:
  static constexpr std::array<std::size_t, 16> lengths{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};

  [[nodiscard]] std::string confirmed(std::string_view word) const {
    return kind_ == Kind::lawicel ? std::string(word) + "\r" : "";
  }
  [[nodiscard]] std::string refused() const { return kind_ == Kind::lawicel ? "\a" : ""; }
  static void add(std::string text, std::vector<std::string>& answers) {
    if (!text.empty()) answers.push_back(std::move(text));
  }

  void slcan(std::string line, EmulatedMotor& motor, std::vector<std::string>& answers) {
    if (kind_ == Kind::canable && line.empty()) line = last_;  // "pressing enter repeats the previous TX"
    last_ = line;
    constexpr std::array<int, 9> rates{10'000, 20'000, 50'000, 100'000, 125'000, 250'000, 500'000, 750'000, 1'000'000};
    switch (line.empty() ? '\0' : line[0]) {
      case 'C':
        is_open_ = false;
        return add(confirmed(""), answers);
      case 'V':
        return add(kind_ == Kind::lawicel ? "V1013\r" : "b158aa7 github.com/normaldotcom/canable2.git\r", answers);
      case 'S':
        if (is_open_ || line.size() != 2 || line[1] < '0' || line[1] > '8') return add(refused(), answers);
        bitrate_ = rates.at(static_cast<std::size_t>(line[1] - '0'));
        return add(confirmed(""), answers);
      case 'Y':
        return add(kind_ == Kind::lawicel ? refused() : "", answers);  // a Lawicel has no CAN FD
      case 'O':
        if (bitrate_ == 0) return add(refused(), answers);
        is_open_ = true;
        return add(confirmed(""), answers);
      default:
        break;
    }
    const auto frame = parsed(line);
    if (!frame || !is_open_ || (frame->is_fd && kind_ == Kind::lawicel)) return add(refused(), answers);
    add(confirmed(frame->is_extended ? "Z" : "z"), answers);
    put_on_bus(*frame, motor, answers);
  }

  void fdcanusb(const std::string& line, EmulatedMotor& motor, std::vector<std::string>& answers) {
    if (line == "can on" || line == "can off") {
      if (is_open_ == (line == "can on")) return add("ERR already in BusOn\r\n", answers);
      is_open_ = !is_open_;
      return add("OK\r\n", answers);
    }
    if (line.starts_with("conf set can.bitrate ")) {
      bitrate_ = std::atoi(line.c_str() + 21);
      return add("OK\r\n", answers);
    }
    const bool is_standard = line.starts_with("can std ");
    const bool is_extended = line.starts_with("can ext ");
    if (!is_standard && !is_extended && !line.starts_with("can send ")) return add("ERR unknown command\r\n", answers);
    if (!is_open_) return add("ERR not in BusOn state\r\n", answers);
    const std::string rest = line.substr(line.find(' ', 4) + 1);
    const std::string id = rest.substr(0, rest.find(' '));
    const std::string more = rest.size() > id.size() ? rest.substr(id.size() + 1) : "";
    const std::string digits = more.substr(0, more.find(' '));
    const std::string flags = more.size() > digits.size() ? more.substr(digits.size() + 1) : "";
    if (digits.empty()) return add("ERR insufficient options\r\n", answers);
    if (flags.find_first_not_of("BbFfRr") != std::string::npos) return add("ERR unknown flag\r\n", answers);
    rig::CanFrame frame;
    frame.id = static_cast<std::uint32_t>(std::strtoul(id.c_str(), nullptr, 16));
    frame.is_extended = is_extended || (!is_standard && frame.id > 0x7ff);
    frame.is_fd = flags.find('f') == std::string::npos;
    frame.is_remote = flags.find('R') != std::string::npos;
    frame.size = digits.size() / 2;
    for (std::size_t i = 0; i < frame.size; ++i) {
      frame.bytes.at(i) = static_cast<unsigned char>(std::strtoul(digits.substr(2 * i, 2).c_str(), nullptr, 16));
    }
    while (frame.is_fd && std::find(lengths.begin(), lengths.end(), frame.size) == lengths.end()) {
      frame.bytes.at(frame.size++) = 0x50;
    }
    add("OK\r\n", answers);
    put_on_bus(frame, motor, answers);
  }

  [[nodiscard]] static std::optional<rig::CanFrame> parsed(const std::string& line) {
    constexpr std::string_view kinds = "tTrRdDbB";
    if (line.empty() || kinds.find(line[0]) == std::string_view::npos) return std::nullopt;
    rig::CanFrame frame;
    frame.is_extended = line[0] < 'a';
    frame.is_remote = line[0] == 'r' || line[0] == 'R';
    frame.is_fd = !frame.is_remote && line[0] != 't' && line[0] != 'T';
    const std::size_t at = frame.is_extended ? 9 : 4;
    if (line.size() <= at) return std::nullopt;
    frame.id = static_cast<std::uint32_t>(std::strtoul(line.substr(1, at - 1).c_str(), nullptr, 16));
    frame.size = lengths.at(std::strtoul(line.substr(at, 1).c_str(), nullptr, 16));
    if (frame.is_remote) return frame;
    if (line.size() != at + 1 + 2 * frame.size) return std::nullopt;
    for (std::size_t i = 0; i < frame.size; ++i) {
      frame.bytes.at(i) = static_cast<unsigned char>(std::strtoul(line.substr(at + 1 + 2 * i, 2).c_str(), nullptr, 16));
    }
    return frame;
  }

  void put_on_bus(const rig::CanFrame& frame, EmulatedMotor& motor, std::vector<std::string>& answers) {
    if (bitrate_ != node_->bitrate()) return;  // the drive sees errors alone
    for (const rig::CanFrame& each : node_->hear(frame, motor)) hand_on(each, answers);
  }

  void hand_on(const rig::CanFrame& frame, std::vector<std::string>& lines) const {
    if (!is_open_ || bitrate_ != node_->bitrate()) return;
    std::string digits;
    for (const unsigned char each : frame.data()) digits += fmt::format("{:02X}", each);
    if (kind_ == Kind::fdcanusb) {
      lines.push_back(fmt::format("rcv {:0{}X} {} {} {} {} {} x-1\r\n", frame.id, frame.id > 0xffff ? 8 : 4, digits,
                                  frame.is_extended ? 'E' : 'e', frame.is_fd ? 'B' : 'b', frame.is_fd ? 'F' : 'f',
                                  frame.is_remote ? 'R' : 'r'));
      return;
    }
    const char kind = frame.is_remote ? 'r' : frame.is_fd ? 'b' : 't';
    const auto length = std::find(lengths.begin(), lengths.end(), frame.size) - lengths.begin();
    lines.push_back(frame.is_extended
                        ? fmt::format("{}{:08X}{:X}{}\r", static_cast<char>(kind - 32), frame.id, length, digits)
                        : fmt::format("{}{:03X}{:X}{}\r", kind, frame.id, length, digits));
  }

  std::unique_ptr<CanNode> node_;
  Kind kind_;
  int bitrate_;
  bool is_open_;
  std::string line_;
  std::string last_;
};

}  // namespace zwidth::test
