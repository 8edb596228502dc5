#pragma once

#include <optional>

#include "zwidth/option_problem.hpp"

namespace zwidth {

/// What a cycle of the loop sends and awaits over a serial line, one after the other.
struct SerialLoad {
  double bytes_per_cycle = 0.0;  ///< question, answer and force together
  double baud = 0.0;             ///< bits/s; a byte takes ten
  double sampling_period = 0.0;  ///< s
};

/// The part of a cycle that may pass on the line; the rest is the drive's and the host's.
inline constexpr double serial_share_of_cycle = 0.8;

/// How often a line carries that many bytes.
///     f = baud / (10 bytes)
/// In Hz. 20 bytes at 115200 Bd: 576 Hz.
[[nodiscard]] double serial_rate(double bytes, double baud);

/// Why the line does not carry the loop, with what would do; nothing where its bytes take at most
/// serial_share_of_cycle of the sampling period.
[[nodiscard]] std::optional<OptionProblem> find_problem(const SerialLoad& load);

}  // namespace zwidth
