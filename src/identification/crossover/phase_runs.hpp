#pragma once

#include <cstddef>
#include <vector>

#include "identification/crossover/phase_lines.hpp"

namespace zwidth::internal {

/// A run of lines on one side of -180 degrees (or of 0 degrees: where the imaginary part has one sign).
struct PhaseRun {
  std::size_t first = 0;  ///< index of its first line
  std::size_t last = 0;
  int sign = 0;  ///< +1: above -180 degrees
};

/// Cuts the band where the sign of the evidence provably changes: runs by rising frequency, signs alternate; empty
/// where nothing is proven.
///
/// The turning points of the evidence's running sum are where the sign changes; one counts where the sum then moves
/// away from it by at least 4 standard deviations of as much pure noise, so that a noisy crossing is one crossing, and
/// hundreds of lines bring no false one. `line_correlation`: see FrequencyResponse.
[[nodiscard]] std::vector<PhaseRun> phase_runs(const std::vector<PhaseLine>& lines, double line_correlation);

}  // namespace zwidth::internal
