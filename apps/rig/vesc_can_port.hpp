#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "rig/can_port.hpp"
#include "rig/vesc_protocol.hpp"

namespace zwidth::rig {

inline constexpr int vesc_can_host = 254;  ///< this program's id on the bus, to which a VESC answers

/// A VESC's packets on a CAN bus, as VESCs hand them on to each other: a current as a command of its own, a payload of up to
/// six bytes in one frame, a longer answer in frames of seven bytes (of six from the 256th on) and one with its length and
/// CRC, which is checked where packets are.
class VescCanPort : public CanPort {
 public:
  /// Of the VESC of that id.
  VescCanPort(std::unique_ptr<CanBus> bus, int id) : CanPort(std::move(bus)), id_(static_cast<unsigned>(id)) {}

  [[nodiscard]] std::optional<CanFrame> frame_of(std::string_view piece) const noexcept override;
  [[nodiscard]] SerialFrame bytes_of(const CanFrame& frame) noexcept override;

 protected:
  [[nodiscard]] std::size_t piece(std::string_view bytes) const noexcept override;

 private:
  unsigned id_;
  std::array<char, vesc_long_payload> payload_{};
  std::size_t filled_ = 0;  // of an answer that comes in several frames
};

}  // namespace zwidth::rig
