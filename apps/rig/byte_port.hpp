#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace zwidth::rig {

/// Where a drive's bytes go and come from: a serial port, or what stands for one on a bus.
///
/// After construction nothing allocates, locks or throws; write() may be called by two threads.
class BytePort {
 public:
  BytePort() = default;
  BytePort(const BytePort&) = delete;
  BytePort& operator=(const BytePort&) = delete;
  virtual ~BytePort() = default;

  /// Hands all of the bytes to the system; false where it has no room for them.
  virtual bool write(std::string_view bytes) noexcept = 0;
  /// What has come, waiting for it until that instant of the clock at most: its size; 0: nothing; -1: the port is gone.
  [[nodiscard]] virtual std::ptrdiff_t read(std::span<char> bytes, std::int64_t until) noexcept = 0;
  /// Forgets what was written and has not left yet.
  virtual void drop_unsent() noexcept = 0;
};

}  // namespace zwidth::rig
