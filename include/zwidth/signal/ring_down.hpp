#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace zwidth {

/// One oscillation a e^{s t} cos(w t + phi) of a signal that decays or grows.
struct RingDown {
  double frequency = 0.0;         ///< w, rad/s
  double growth_rate = 0.0;       ///< s, 1/s; negative: it decays
  double growth_deviation = 0.0;  ///< standard error of the growth rate, 1/s
  double amplitude = 0.0;         ///< at the end of what was read, in the signal's unit
  std::size_t windows = 0;        ///< that were read
};

inline constexpr double ring_window_cycles = 6.0;  ///< of the oscillation, in each window of ring_down()

/// The oscillation of a signal near a frequency, and how fast it grows.
///
///     S_j = sum_n h[n] x[j hop + n] e^{-jw(j hop + n)T},   ln |S_j| = s t_j + const,   arg S_j = (w' - w) t_j + const
///
/// with Hann windows h of six cycles, three quarters overlapping; w is then w', and again, until it stays. The growth of
/// a single oscillation is exact whatever its rate, for its windowed amplitude grows as it does. Windows after the signal
/// has fallen below `floor` (in its unit, e.g. an encoder step), or below 1e-9 of its largest, are left out.
///
/// Absent where the signal has less than three windows, where fewer than five are above the floor, where the frequency
/// does not settle within a factor of two, and where no single oscillation explains the windows (residual of ln |S|
/// above 0.3).
/// Requires finite samples, period > 0 and 0 < frequency < pi/period; throws Error (invalid_argument) otherwise.
[[nodiscard]] std::optional<RingDown> ring_down(std::span<const double> signal, double period, double frequency,
                                                double floor = 0.0);

}  // namespace zwidth
