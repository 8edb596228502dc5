#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace zwidth::rig {

/// A frame of the UDP protocol, both ways: 40 bytes, little-endian, in SI units (docs/rig_drives.md).
///
///     offset   0        4      12         20         28      36
///              sequence time   position   velocity   force   CRC-32 (polynomial 0x04C11DB7, as in zlib) of what stands before
///              uint32   double double     double     double  uint32
///
/// To the drive: `force` is what to apply from now on; NaN asks for the position alone. From the drive, one per frame:
/// the sequence of the frame that it answers, and the force that it applies; NaN: it has let go.
struct UdpFrame {
  static constexpr std::size_t size = 40;

  std::uint32_t sequence = 0;
  double time = 0.0;      ///< s, of the sender's clock
  double position = 0.0;  ///< m or rad
  double velocity = 0.0;  ///< m/s or rad/s
  double force = 0.0;     ///< N or N m
};

[[nodiscard]] std::array<std::byte, UdpFrame::size> encoded(const UdpFrame& frame) noexcept;
/// Nothing for bytes of another number or with another CRC.
[[nodiscard]] std::optional<UdpFrame> decoded_udp_frame(std::span<const std::byte> bytes) noexcept;

}  // namespace zwidth::rig
