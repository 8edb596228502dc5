#pragma once

#include <cstddef>
#include <vector>

#include "zwidth/signal/window.hpp"

namespace zwidth::internal {

/// w[i], i = 0 .. length - 1, in its periodic form (the next value would be w[0]); length >= 1.
[[nodiscard]] std::vector<double> window_function(Window window, std::size_t length);

/// Lines from the middle of the main lobe to its first zero: nearer to 0 Hz than this a constant leaks into.
[[nodiscard]] std::size_t main_lobe_half_width(Window window);

/// Second moment of |W|^2 about its middle, in lines^2: sum w'^2 / sum w^2. The window's smearing changes a response H
/// by H'' / 2 times this. None for a rectangular window: its sidelobes fall too slowly for a moment to exist.
[[nodiscard]] double lobe_second_moment(Window window);

/// How many independent segments are worth as much as `segments` of them that overlap, `step` samples apart, for the
/// variance of a spectrum of broadband noise: n / (1 + 2 sum_j (1 - j/n) rho_j^2). Source: Welch 1967, eq. 12.
[[nodiscard]] double independent_segments(const std::vector<double>& window, std::size_t segments, std::size_t step);

/// Magnitude of the correlation of broadband noise between two lines: |sum w^2 e^{2 pi j k i / L}| / sum w^2.
[[nodiscard]] double noise_correlation(Window window, std::size_t lines_apart);

/// Variance of the sum of the noise of many neighbouring lines over that of as many independent ones, at worst:
/// 1 + 2 sum_k noise_correlation(k).
[[nodiscard]] double line_correlation(Window window);

}  // namespace zwidth::internal
