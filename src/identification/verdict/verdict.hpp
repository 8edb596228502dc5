#pragma once

#include <optional>
#include <string>
#include <vector>

#include "identification/verdict/omnibus.hpp"
#include "zwidth/finding.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::internal {

/// A range of the critical stiffness, N/m or N m/rad.
struct LimitRange {
  double lower = 0.0;
  double upper = 0.0;
};

/// A record that a residual may stand out in.
struct NamedRecord {
  std::string source;            ///< where it was read from
  double sampling_period = 0.0;  ///< s
};

/// What is known of a fit when it is judged.
struct FittedLikelihood {
  std::optional<LimitRange> limit;      ///< all within 1.92 of the best log-likelihood; absent: nothing is determined
  std::optional<Omnibus> left;          ///< of what it leaves in time; absent: lines of a response alone
  std::vector<NamedRecord> records;     ///< those that `left` counts
  std::vector<Finding> contradictions;  ///< data or given numbers that contradict each other
};

/// Sound where the interval is within Calibration::widest_interval and what is left does not stand out; doubtful where it is
/// wider, or stands out; refused where nothing is determined, or the data contradict themselves.
[[nodiscard]] Trust verdict_of(const FittedLikelihood& fit);

}  // namespace zwidth::internal
