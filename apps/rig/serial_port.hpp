#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "rig/byte_port.hpp"

namespace zwidth::rig {

/// A serial port, raw and non-blocking, for this process alone: 8 data bits, no parity, one stop bit, no flow control.
///
/// A line that has no room and is cut in two ends, with `line_end`, before the next one begins.
class SerialPort : public BytePort {
 public:
  /// Throws DriverFailed where it cannot be opened, is no serial port, does not take the speed, or another program has it.
  SerialPort(const std::string& path, int baud, char line_end = '\n');
  ~SerialPort() override;

  bool write(std::string_view bytes) noexcept override;
  [[nodiscard]] std::ptrdiff_t read(std::span<char> bytes, std::int64_t until) noexcept override;
  void drop_unsent() noexcept override;

 private:
  int file_ = -1;
  char line_end_;
  std::atomic<bool> is_torn_ = false;
};

}  // namespace zwidth::rig
