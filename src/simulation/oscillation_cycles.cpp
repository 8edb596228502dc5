#include "simulation/oscillation_cycles.hpp"

#include <algorithm>

namespace zwidth::internal {

OscillationCycles oscillation_cycles(std::span<const double> signal, double threshold) {
  OscillationCycles cycles;
  bool is_low = false;     // was below -threshold last, rather than above +threshold
  bool has_begun = false;  // at least one rise is confirmed
  double rise = 0.0;       // last rise through 0 while low: the next cycle's start, once +threshold is passed
  double start = 0.0;      // of the current cycle
  double first_start = 0.0;
  double lowest = 0.0;
  double highest = 0.0;
  for (std::size_t i = 1; i < signal.size(); ++i) {
    const double y = signal[i];
    const double previous = signal[i - 1];
    if (is_low && previous <= 0.0 && y > 0.0) {
      rise = static_cast<double>(i) - y / (y - previous);
    }
    lowest = std::min(lowest, y);
    if (y < -threshold) is_low = true;
    if (is_low && y > threshold) {
      is_low = false;
      if (has_begun) {
        ++cycles.count;
        cycles.mean_swing += 0.5 * (highest - lowest);
      } else {
        first_start = rise;
      }
      has_begun = true;
      start = rise;
      lowest = highest = y;
    }
    highest = std::max(highest, y);
  }
  if (cycles.count > 0) {
    const auto count = static_cast<double>(cycles.count);
    cycles.mean_length = (start - first_start) / count;
    cycles.mean_swing /= count;
  }
  return cycles;
}

}  // namespace zwidth::internal
