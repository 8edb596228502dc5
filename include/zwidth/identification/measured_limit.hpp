#pragma once

#include <optional>

#include "zwidth/option_problem.hpp"

namespace zwidth {

/// A wall at which a device was seen to begin to oscillate.
struct MeasuredLimit {
  double stiffness = 0.0;              ///< K > 0, N/m or N m/rad
  double damping = 0.0;                ///< B >= 0 of the same wall
  std::optional<double> frequency_hz;  ///< of the oscillation, > 0; absent: not measured
  /// Standard deviation of log K: K is turned up by hand in steps of about a tenth.
  double stiffness_deviation = 0.1;
  /// Standard deviation of log f: counted in a plot or by ear, half a semitone.
  double frequency_deviation = 0.03;
};

/// Names the first member that is out of its range; nothing where all are right.
[[nodiscard]] std::optional<OptionProblem> find_problem(const MeasuredLimit& limit);

}  // namespace zwidth
