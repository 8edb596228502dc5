#pragma once

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "rig/emulated_motor.hpp"
#include "rig/firmware.hpp"

namespace zwidth::test {

/// How an emulated line differs from a pair of wires that work.
struct LineOptions {
  int baud = 0;           ///< of the drive; 0: the firmware's default
  bool is_paced = false;  ///< bytes take the time that they take at that speed
};

/// An emulated drive behind a pseudo-terminal, which a program opens as a serial port.
///
/// A line of another speed than the drive's brings it nothing that it could read.
class PtyEmulator {
 public:
  enum class Fault {
    none,
    silent,
    half_frames,
    wrong_checksum,
    not_a_number,
    late,
    lost_answers,  // every seventh
    stalled,
    no_watchdog,
    failed_drive,
    unplugged
  };

  PtyEmulator(std::unique_ptr<Firmware> firmware, const Device& device, LineOptions line = {})
      : firmware_(std::move(firmware)),
        motor_(device),
        line_(line),
        master_(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    std::array<char, 128> name{};
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0 ||
        ptsname_r(master_, name.data(), name.size()) != 0) {
      throw std::runtime_error("no pseudo-terminal");
    }
    if (line_.baud == 0) line_.baud = firmware_->baud();
    fcntl(master_, F_SETFL, fcntl(master_, F_GETFL) | O_NONBLOCK);
    path_ = name.data();
    slave_ = open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);  // else the master hangs up between two hosts
    termios settings{};
    tcgetattr(slave_, &settings);
    cfmakeraw(&settings);
    tcsetattr(slave_, TCSANOW, &settings);
    thread_ = std::thread([this] { run(); });
  }
  ~PtyEmulator() {
    is_ending_ = true;
    thread_.join();
    close(slave_);
    if (master_ >= 0) close(master_);
  }
  PtyEmulator(const PtyEmulator&) = delete;
  PtyEmulator& operator=(const PtyEmulator&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const EmulatedMotor& motor() const { return motor_; }
  /// Where frames are cut off: any number.
  void set_place(unsigned place) { place_ = place; }
  /// What is told to it acts at once.
  [[nodiscard]] EmulatedMotor& motor() { return motor_; }
  /// ms, by which answers come late.
  void set_answer_delay(int answer_delay) { answer_delay_ = answer_delay; }
  void set_fault(Fault fault) {
    motor_.is_not_a_number = fault == Fault::not_a_number;
    fault_ = fault;
  }

 private:
  void run() {
    sched_param priority{};  // where that is allowed: firmware has a processor of its own
    priority.sched_priority = 90;
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
    std::array<char, 4096> bytes{};
    while (!is_ending_) {
      pollfd waiting{master_, POLLIN, 0};
      const timespec longest = longest_wait();
      const bool has_input = master_ >= 0 && ppoll(&waiting, 1, &longest, nullptr) > 0;
      firmware_->tick(Clock::now(), fault_ != Fault::no_watchdog, motor_);
      if (fault_ == Fault::unplugged) {
        if (master_ >= 0) close(std::exchange(master_, -1));
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        continue;
      }
      if (fault_ == Fault::stalled) {  // bytes wait in the line
        for (int i = 0; i < 150 && !is_ending_; ++i) {
          std::this_thread::sleep_for(std::chrono::milliseconds(2));
          firmware_->tick(Clock::now(), true, motor_);
        }
      }
      if (fault_ == Fault::failed_drive && !std::exchange(has_failed_, true)) firmware_->fail(motor_);
      if (has_input) {
        const ssize_t count = read(master_, bytes.data(), bytes.size());
        if (count > 0 && has_same_speed()) travel(inbox_, {bytes.data(), static_cast<std::size_t>(count)});
      }
      while (const auto arrived = inbox_.arrived()) {
        for (std::string& frame : firmware_->receive(*arrived, motor_)) answer(std::move(frame));
      }
      for (std::string& frame : firmware_->unasked(motor_)) tell(std::move(frame));
      while (const auto arrived = outbox_.arrived()) put(*arrived);
    }
  }

  /// Bytes under way in one direction, one after the other.
  struct Wire {
    std::deque<std::pair<Clock::time_point, std::string>> under_way;
    Clock::time_point free_at;

    [[nodiscard]] std::optional<std::string> arrived() {
      if (under_way.empty() || under_way.front().first > Clock::now()) return std::nullopt;
      std::string bytes = std::move(under_way.front().second);
      under_way.pop_front();
      return bytes;
    }
  };

  void travel(Wire& wire, std::string bytes) const {
    const double time = line_.is_paced ? firmware_->time_on_wire(bytes, line_.baud) : 0.0;
    wire.free_at = std::max(wire.free_at, Clock::now()) +
                   std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time));
    wire.under_way.emplace_back(wire.free_at, std::move(bytes));
  }

  [[nodiscard]] timespec longest_wait() const {
    Clock::duration wait = std::chrono::milliseconds(2);  // the watchdog looks although nothing comes
    for (const Wire* wire : {&inbox_, &outbox_}) {
      if (!wire->under_way.empty()) wait = std::min(wait, wire->under_way.front().first - Clock::now());
    }
    return {0, std::max<long>(0, std::chrono::duration_cast<std::chrono::nanoseconds>(wait).count())};
  }

  void answer(std::string frame) {
    const Fault fault = fault_;
    if (fault == Fault::silent) return;
    if (fault == Fault::lost_answers && ++answers_ % 7 == 0) return;
    if (fault == Fault::wrong_checksum) frame[frame.size() / 2] ^= 1;
    if (fault == Fault::half_frames) frame.resize(place_ % frame.size());
    if (fault == Fault::late) std::this_thread::sleep_for(std::chrono::milliseconds(answer_delay_));
    travel(outbox_, std::move(frame));
  }

  /// What nobody asked for: lost and broken as answers are, but never late.
  void tell(std::string frame) {
    const Fault fault = fault_;
    if (fault == Fault::silent) return;
    if (fault == Fault::wrong_checksum) frame[frame.size() / 2] ^= 1;
    if (fault == Fault::half_frames) frame.resize(place_ % frame.size());
    travel(outbox_, std::move(frame));
  }

  void put(const std::string& frame) {
    std::size_t sent = 0;
    while (sent < frame.size() && !is_ending_) {
      constexpr int longest = 2;  // ms: nobody may be reading any more
      pollfd room{master_, POLLOUT, 0};
      if (poll(&room, 1, longest) == 0) continue;
      const ssize_t count = write(master_, frame.data() + sent, frame.size() - sent);
      if (count < 0 && errno == EAGAIN) continue;
      if (count <= 0) return;
      sent += static_cast<std::size_t>(count);
    }
  }

  [[nodiscard]] bool has_same_speed() const {
    constexpr std::array<std::pair<int, speed_t>, 5> speeds{
        {{9600, B9600}, {115200, B115200}, {921600, B921600}, {1000000, B1000000}, {4000000, B4000000}}};
    termios settings{};
    if (tcgetattr(slave_, &settings) != 0) return false;
    const auto* const own =
        std::find_if(speeds.begin(), speeds.end(), [&](auto each) { return each.first == line_.baud; });
    return own != speeds.end() && cfgetospeed(&settings) == own->second;
  }

  std::unique_ptr<Firmware> firmware_;
  EmulatedMotor motor_;
  LineOptions line_;
  int master_;
  int slave_ = -1;
  std::string path_;
  Wire inbox_;
  Wire outbox_;
  int answers_ = 0;
  bool has_failed_ = false;
  std::atomic<bool> is_ending_ = false;
  std::atomic<Fault> fault_ = Fault::none;
  std::atomic<unsigned> place_ = 5;
  std::atomic<int> answer_delay_ = 60;
  std::thread thread_;
};

}  // namespace zwidth::test
