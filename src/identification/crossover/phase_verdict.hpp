#pragma once

#include <span>
#include <vector>

#include "identification/crossover/local_estimate.hpp"
#include "identification/crossover/phase_lines.hpp"

namespace zwidth::internal {

/// On which side of -180 degrees a line lies, judged together with its neighbours.
struct PhaseVerdict {
  Estimate deviation;      ///< of the phase from -180 degrees, rad; smoothed near -180 degrees
  Estimate log_magnitude;  ///< of ln |P|; smoothed where the deviation is
  int sign = 0;            ///< +1: above, -1: below; 0: open, the deviation is within 95 % of none
};

/// A phase so far from -180 degrees is no matter of noise (a measured line is known within 30 degrees), and not on a
/// smooth curve with what happens there.
[[nodiscard]] bool is_far(const PhaseLine& line);

/// The line's deviation from -180 degrees over the logarithm of its frequency, of which a device's phase is smoother.
[[nodiscard]] CurveSample phase_sample(const PhaseLine& line);

/// One verdict per line. A line that is not measured is open.
[[nodiscard]] std::vector<PhaseVerdict> phase_verdicts(std::span<const PhaseLine> lines, double line_correlation);

}  // namespace zwidth::internal
