#pragma once

namespace zwidth {

/// What counts of a frame for its time on a CAN bus.
struct CanFrameShape {
  unsigned bytes = 0;        ///< of data: 0 to 8; of CAN FD 0 to 8, 12, 16, 20, 24, 32, 48 or 64
  bool is_extended = false;  ///< an identifier of 29 bits instead of 11
  bool is_remote = false;    ///< a question, which carries no data; none of CAN FD
  bool is_fd = false;        ///< CAN FD, whose rate changes for the data
};

/// How fast a CAN bus is, in bits/s.
struct CanBitRates {
  double nominal = 0.0;  ///< of all but that data
  double data = 0.0;     ///< of CAN FD, from its bit rate switch to the end of its CRC
};

/// The longest that a frame may take, with every bit stuffed that may be and the space behind it.
///     t = (g + 13 + floor((g - 1)/4))/f,   g = 34 + 8 n or, extended, 54 + 8 n
/// In s; g: the bits of n bytes that are stuffed, 13: delimiters, acknowledgement, end and three of space. CAN FD has its
/// arbitration, acknowledgement, end and space at f, and the rest, with fixed stuff bits in its CRC, at the data's rate.
/// Source: ISO 11898-1:2015, 10.4 and 10.5; Davis, Burns, Bril, Lukkien, Controller Area Network (CAN) schedulability
/// analysis: refuted, revisited and revised, Real-Time Systems 35 (2007), equation (1).
[[nodiscard]] double can_frame_time(const CanFrameShape& frame, const CanBitRates& rates);

}  // namespace zwidth
