#include "zwidth/rig/can_frame_time.hpp"

namespace zwidth {
namespace {

constexpr unsigned between_stuff_bits = 4;   // at worst: five alike, one stuffed, which begins the next five
constexpr unsigned behind_stuffed = 10 + 3;  // CRC delimiter, acknowledgement and its delimiter, end of frame; space
constexpr unsigned behind_fd_data = 9 + 3;   // the same without the CRC delimiter, which the data's rate has
constexpr unsigned most_bytes_of_short_crc = 16;

unsigned stuffed(unsigned bits) { return bits + (bits - 1) / between_stuff_bits; }

double fd_frame_time(const CanFrameShape& frame, const CanBitRates& rates) {
  const unsigned arbitration = frame.is_extended ? 36 : 17;  // from the start of frame to the bit rate switch
  const unsigned head_and_data = 5 + 8 * frame.bytes;        // error state, length, data
  const unsigned crc = 4 + (frame.bytes <= most_bytes_of_short_crc ? 17 : 21);  // count of stuff bits, parity, CRC
  const unsigned fixed_stuff_bits = (crc + between_stuff_bits - 1) / between_stuff_bits;
  const unsigned at_data_rate =
      head_and_data + (head_and_data + between_stuff_bits - 1) / between_stuff_bits + crc + fixed_stuff_bits + 1;
  return (stuffed(arbitration) + behind_fd_data) / rates.nominal + at_data_rate / rates.data;
}

}  // namespace

double can_frame_time(const CanFrameShape& frame, const CanBitRates& rates) {
  if (frame.is_fd) return fd_frame_time(frame, rates);
  const unsigned data = frame.is_remote ? 0 : 8 * frame.bytes;
  return (stuffed((frame.is_extended ? 54 : 34) + data) + behind_stuffed) / rates.nominal;
}

}  // namespace zwidth
