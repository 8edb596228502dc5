#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "identification/crossover/phase_lines.hpp"
#include "identification/crossover/phase_runs.hpp"
#include "identification/crossover/phase_verdict.hpp"
#include "zwidth/identification/measured_stiffness.hpp"

namespace zwidth::internal {

/// A proven crossing, and the lines between which it may lie.
struct FittedCrossing {
  MeasuredCrossover crossover;
  std::size_t first_open = 0;  ///< lines [first_open, end_open) are open, or contradict the run that they lie in
  std::size_t end_open = 0;
  /// The neighbouring lines between which the phase makes so long a step that a resonance may peak unseen; else absent.
  std::optional<Interval> sparse_lines;
};

/// Where the phase passes -180 degrees between two runs that meet, with its 95 % intervals.
///
/// By the curve of 1/P around it (stiffness_curve.hpp) and its profile, with what bends between the two neighbouring lines beside.
/// Where no curve tells: by interpolation of phase and ln |P| between the two lines, and where the noise makes the phase
/// pass several times near by, of the smoothed ones; the interval then reaches on either side to the outermost line that is not
/// proven to be on its run's side. `line_correlation`: see FrequencyResponse.
/// Where the phase falls far between the two lines, a resonance lies between them: there 1/P is nearly a straight line,
/// and the interval holds both lines.
/// Nothing where the phase passes 0 instead of -180 degrees, or steps so far that it may have done either.
[[nodiscard]] std::optional<FittedCrossing> fitted_crossing(std::span<const PhaseLine> lines,
                                                            std::span<const PhaseVerdict> verdicts,
                                                            const PhaseRun& below, const PhaseRun& above,
                                                            double line_correlation);

/// The last measured line of one run and the first of the next.
struct MeetingLines {
  std::size_t before = 0;
  std::size_t after = 0;
};
[[nodiscard]] MeetingLines meeting_lines(std::span<const PhaseLine> lines, const PhaseRun& below,
                                         const PhaseRun& above);

/// The phase steps by so much between these neighbours that it may have gone either way round.
[[nodiscard]] bool is_ambiguous_step(const PhaseLine& before, const PhaseLine& after);

}  // namespace zwidth::internal
