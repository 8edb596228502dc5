#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace zwidth::rig {

class BytePort;

/// What has come on a serial line and is not taken yet. Nothing allocates.
class SerialInput {
 public:
  /// In the order in which it came. Valid until the next fill().
  [[nodiscard]] std::string_view bytes() const noexcept { return {bytes_.data() + begin_, end_ - begin_}; }
  /// The first `size` bytes, from then on no longer part of it.
  std::string_view take(std::size_t size) noexcept;
  /// Whether more came, until that instant of the clock at most. What fills 1024 bytes is no frame and is dropped.
  [[nodiscard]] bool fill(BytePort& port, std::int64_t until) noexcept;
  /// Whether the port is gone, as of the last fill().
  [[nodiscard]] bool has_failed() const noexcept { return has_failed_; }
  void forget() noexcept { begin_ = end_ = 0; }

 private:
  std::array<char, 1024> bytes_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  bool has_failed_ = false;
};

}  // namespace zwidth::rig
