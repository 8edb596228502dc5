// Any bytes, as a frame of the UDP drive: never a crash; what is taken is encoded to the same bytes again.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "rig/udp_frame.hpp"

namespace {

/// The bytes with a CRC that is right, so that what lies behind it is reached too.
std::vector<std::byte> with_right_crc(std::span<const std::byte> bytes) {
  zwidth::rig::UdpFrame frame;
  std::copy_n(bytes.begin(), sizeof frame.sequence, std::as_writable_bytes(std::span(&frame.sequence, 1)).begin());
  auto numbers = bytes.subspan(sizeof frame.sequence);
  for (double* number : {&frame.time, &frame.position, &frame.velocity, &frame.force}) {
    std::copy_n(numbers.begin(), sizeof *number, std::as_writable_bytes(std::span(number, 1)).begin());
    numbers = numbers.subspan(sizeof *number);
  }
  const auto encoded = zwidth::rig::encoded(frame);
  return {encoded.begin(), encoded.end()};
}

void check(std::span<const std::byte> bytes) {
  const auto frame = zwidth::rig::decoded_udp_frame(bytes);
  if (frame && !std::ranges::equal(zwidth::rig::encoded(*frame), bytes)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  check(bytes);
  if (size < zwidth::rig::UdpFrame::size) return 0;
  const std::vector<std::byte> right = with_right_crc(bytes);
  if (!zwidth::rig::decoded_udp_frame(right)) std::abort();
  check(right);
  return 0;
}
