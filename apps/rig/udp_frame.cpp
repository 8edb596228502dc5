#include "rig/udp_frame.hpp"

#include <bit>
#include <boost/crc.hpp>
#include <cstring>

namespace zwidth::rig {
namespace {

static_assert(std::endian::native == std::endian::little, "frames are copied as they stand in memory");
constexpr std::size_t crc_at = UdpFrame::size - sizeof(std::uint32_t);

std::uint32_t crc_of(const std::byte* bytes) noexcept {
  boost::crc_32_type crc;
  crc.process_bytes(bytes, crc_at);
  return crc.checksum();
}

}  // namespace

std::array<std::byte, UdpFrame::size> encoded(const UdpFrame& frame) noexcept {
  std::array<std::byte, UdpFrame::size> bytes{};
  const std::array<double, 4> numbers{frame.time, frame.position, frame.velocity, frame.force};
  std::memcpy(bytes.data(), &frame.sequence, sizeof frame.sequence);
  std::memcpy(bytes.data() + sizeof frame.sequence, numbers.data(), sizeof numbers);
  const std::uint32_t crc = crc_of(bytes.data());
  std::memcpy(bytes.data() + crc_at, &crc, sizeof crc);
  return bytes;
}

std::optional<UdpFrame> decoded_udp_frame(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != UdpFrame::size) return std::nullopt;
  std::uint32_t crc = 0;
  std::memcpy(&crc, bytes.data() + crc_at, sizeof crc);
  if (crc != crc_of(bytes.data())) return std::nullopt;
  UdpFrame frame;
  std::array<double, 4> numbers{};
  std::memcpy(&frame.sequence, bytes.data(), sizeof frame.sequence);
  std::memcpy(numbers.data(), bytes.data() + sizeof frame.sequence, sizeof numbers);
  frame.time = numbers[0];
  frame.position = numbers[1];
  frame.velocity = numbers[2];
  frame.force = numbers[3];
  return frame;
}

}  // namespace zwidth::rig
