#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "zwidth/rig/can_frame_time.hpp"

namespace zwidth::rig {

/// A frame on a CAN bus. CAN FD with its rate switched, or classic.
struct CanFrame {
  static constexpr std::size_t most_bytes = 64;

  std::uint32_t id = 0;  ///< 11 bits, extended 29
  bool is_extended = false;
  bool is_remote = false;  ///< a question for `size` bytes, with none of its own
  bool is_fd = false;
  std::size_t size = 0;
  std::array<unsigned char, most_bytes> bytes{};

  [[nodiscard]] std::span<const unsigned char> data() const noexcept {
    return std::span(bytes).first(is_remote ? 0 : size);
  }
  [[nodiscard]] CanFrameShape shape() const noexcept {
    return {static_cast<unsigned>(size), is_extended, is_remote, is_fd};
  }
  bool operator==(const CanFrame& other) const noexcept = default;
};

/// The bytes of the next frame length that CAN FD has: 9 to 12, 13 to 16; nothing beyond 64.
[[nodiscard]] std::optional<std::size_t> can_fd_size(std::size_t bytes) noexcept;

/// A CAN bus behind an adapter, for this process alone.
///
/// After construction nothing allocates, locks or throws; send() may be called by two threads.
class CanBus {
 public:
  CanBus() = default;
  CanBus(const CanBus&) = delete;
  CanBus& operator=(const CanBus&) = delete;
  virtual ~CanBus() = default;

  /// Hands the frame to the adapter; false where it takes none.
  virtual bool send(const CanFrame& frame) noexcept = 0;
  /// The next frame, waiting for it until that instant of the clock at most.
  [[nodiscard]] virtual std::optional<CanFrame> receive(std::int64_t until) noexcept = 0;
  /// Whether the adapter is gone.
  [[nodiscard]] virtual bool is_gone() const noexcept = 0;
  /// Forgets what was sent and has not left yet.
  virtual void drop_unsent() noexcept = 0;
};

/// An adapter: "/dev/ttyACM0", of another speed than USB's "/dev/ttyUSB0@115200", or a SocketCAN interface, "can0".
struct CanAdapter {
  std::string place;
  std::optional<int> baud = {};  ///< of a serial port; absent: a SocketCAN interface
};

/// What a name of an adapter stands for; nothing where it names none.
[[nodiscard]] std::optional<CanAdapter> can_adapter(std::string_view name);

/// The bus behind that adapter, at these rates, of which that of data is 0 without CAN FD. Throws DriverFailed where it is
/// not to be had.
[[nodiscard]] std::unique_ptr<CanBus> open_can_bus(const CanAdapter& adapter, const CanBitRates& rates);

}  // namespace zwidth::rig
