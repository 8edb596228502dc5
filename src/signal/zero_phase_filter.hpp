#pragma once

#include <span>
#include <vector>

namespace zwidth::internal {

/// Low-pass without phase: a Butterworth filter of fourth order run forwards and then backwards.
///
///     gain(f) = 1 / (1 + (tan(pi f/rate) / tan(pi fc/rate))^8),  one half at the cutoff fc
///
/// `cutoff` is fc / rate, in (0, 0.5). Before both runs the signal is continued beyond its ends by its point reflection
/// (six periods of the cutoff, or all there is) and the filter starts settled, so that a constant and a straight line
/// pass unchanged. Throws Error (invalid_argument) for a cutoff outside its domain.
/// Source: Gustafsson 1996 on transients of forward-backward filters; the reflection is the usual remedy.
[[nodiscard]] std::vector<double> zero_phase_low_pass(std::span<const double> signal, double cutoff);

}  // namespace zwidth::internal
