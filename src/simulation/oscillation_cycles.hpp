#pragma once

#include <cstddef>
#include <span>

namespace zwidth::internal {

/// The cycles of an oscillation about 0.
struct OscillationCycles {
  std::size_t count = 0;     ///< whole cycles
  double mean_length = 0.0;  ///< samples; 0 without a cycle
  double mean_swing = 0.0;   ///< half of peak to peak, averaged over the cycles
};

/// A cycle lasts from one rise through 0 to the next, where the signal has been below -threshold and above +threshold
/// in between: smaller wiggles make no cycle of their own. The rises are interpolated between samples.
[[nodiscard]] OscillationCycles oscillation_cycles(std::span<const double> signal, double threshold);

}  // namespace zwidth::internal
