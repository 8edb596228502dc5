#pragma once

#include <optional>
#include <span>

#include "zwidth/simulation/simulate.hpp"

namespace zwidth::internal {

struct LoopJudgement {
  LoopVerdict verdict = LoopVerdict::undecided;
  std::optional<double> growth_rate;       ///< 1/s, of the envelope over the second half; absent without oscillation
  std::optional<Oscillation> oscillation;  ///< at the end of the run, whatever the verdict; absent at rest
};

/// Judges a run by its position. Its second half is cut into eight windows of whole cycles (from one lowest point of
/// the position, about a straight line, to another); the trend of the logarithm of their effective swings about a
/// straight line decides: it must exceed 1 % over the second half, and four of its standard errors. What swings less
/// than the encoder's step, or a millionth of the range of the run, is at rest. A curve without turning points is no
/// oscillation, however bent.
[[nodiscard]] LoopJudgement judge_loop(std::span<const double> position, double sampling_period, double resolution);

}  // namespace zwidth::internal
