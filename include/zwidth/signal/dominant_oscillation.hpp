#pragma once

#include <optional>
#include <span>

namespace zwidth {

/// The strongest oscillation of a signal.
struct DominantOscillation {
  double frequency = 0.0;   ///< rad/s
  double amplitude = 0.0;   ///< half of peak to peak of that sine, in the signal's unit
  double share = 0.0;       ///< of the power that varies, 0..1: what else moves takes the rest
  double resolution = 0.0;  ///< rad/s, spacing of the spectrum's lines
  double change = 1.0;      ///< its amplitude in the second half of the stretch / in the first: below 1 it dies out
};

/// The highest peak of the last half's spectrum (at most 2^17 samples), Hann-windowed, without its straight line; the
/// peak is interpolated by a parabola through the logarithms of three lines, to a tenth of a line on a sine.
///
/// Absent where nothing moves, below 64 samples, and where the peak is not above four lines: slower than four cycles in
/// the stretch. Requires a period > 0 and finite samples; throws Error (invalid_argument) otherwise.
[[nodiscard]] std::optional<DominantOscillation> dominant_oscillation(std::span<const double> signal, double period);

}  // namespace zwidth
