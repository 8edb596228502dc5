#pragma once

#include <span>
#include <vector>

namespace zwidth::internal {

/// cosine cos(angle k) + sine sin(angle k) at the samples k, counted from the end of the signal it was fitted to: the
/// last sample has k = 0, the one before -1.
struct FittedSine {
  double angle = 0.0;  ///< rad per sample
  double cosine = 0.0;
  double sine = 0.0;
  double amplitude = 0.0;
};

/// The oscillation of that angle per sample in a signal, beside a straight line, by least squares.
[[nodiscard]] FittedSine fit_sine(std::span<const double> signal, double angle);

/// The signal, which ends where the fitted one did, less the oscillation.
[[nodiscard]] std::vector<double> without(const FittedSine& sine, std::span<const double> signal);

}  // namespace zwidth::internal
