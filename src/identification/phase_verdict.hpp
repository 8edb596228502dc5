#pragma once

#include <span>
#include <vector>

#include "identification/local_estimate.hpp"
#include "identification/phase_lines.hpp"

namespace zwidth {

/// On which side of -180 degrees a line lies, judged together with its neighbours.
struct PhaseVerdict {
  Estimate deviation;      ///< of the phase from -180 degrees, rad; smoothed near -180 degrees
  Estimate log_magnitude;  ///< of ln |P|; smoothed where the deviation is
  int sign = 0;            ///< +1: above, -1: below; 0: open, the deviation is within 95 % of none
};

/// One verdict per line. A line that is not measured is open.
[[nodiscard]] std::vector<PhaseVerdict> phase_verdicts(std::span<const PhaseLine> lines, double line_correlation);

}  // namespace zwidth
