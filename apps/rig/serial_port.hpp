#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace zwidth::rig {

/// A serial port, raw and non-blocking, for this process alone: 8 data bits, no parity, one stop bit, no flow control.
///
/// After construction nothing allocates, locks or throws; write() may be called by two threads.
class SerialPort {
 public:
  /// Throws DriverFailed where it cannot be opened, is no serial port, does not take the speed, or another program has it.
  SerialPort(const std::string& path, int baud);
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  /// Hands all of the bytes to the system; false where it has no room for them. A line that this cuts in two ends before
  /// the next one begins.
  bool write(std::string_view bytes) noexcept;
  /// What has come, waiting for it until that instant of the clock at most: its size; 0: nothing; -1: the port is gone.
  [[nodiscard]] std::ptrdiff_t read(std::span<char> bytes, std::int64_t until) noexcept;
  /// Forgets what was written and has not left yet.
  void drop_unsent() noexcept;

 private:
  int file_ = -1;
  std::atomic<bool> is_torn_ = false;
};

}  // namespace zwidth::rig
