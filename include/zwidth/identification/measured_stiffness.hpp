#pragma once

#include <optional>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"

namespace zwidth {

/// Of 95 %.
struct Interval {
  double lower = 0.0;  ///< its lower end
  double upper = 0.0;  ///< its upper end
};

/// A wall stiffness at which the measured response says that a closed-loop pole lies on the unit circle.
struct MeasuredCrossover {
  double frequency = 0.0;       ///< rad/s, where the phase passes -180 degrees
  double stiffness = 0.0;       ///< K = 1/|P| there
  Interval frequency_interval;  ///< 95 %
  Interval stiffness_interval;  ///< 95 %
  /// +2: the phase falls through -180 degrees; -2: it rises; at the Nyquist frequency +1 or -1
  int poles_leaving = 0;
};

/// Whether a response shows a limit.
enum class MeasuredStiffnessStatus {
  found,         ///< the least crossover, with its interval
  not_in_band,   ///< the crossover that limits does not lie between the lowest and the highest measured frequency
  undetermined,  ///< the noise hides whether there is a softer crossover than those that are proven
};

/// The critical stiffness read off a measured response of the sampled plant, without any model.
struct MeasuredStiffness {
  MeasuredStiffnessStatus status = MeasuredStiffnessStatus::found;  ///< whether the response shows a crossover
  /// The crossover of least stiffness that the data prove. It is the critical stiffness only when found; when
  /// undetermined, the critical stiffness is at most this. Absent when not_in_band.
  std::optional<MeasuredCrossover> limit;
  std::vector<MeasuredCrossover> crossovers;  ///< all that the data prove, by rising frequency
  /// Bands that may hide a crossover softer than the limit: the phase cannot be told from -180 degrees, or is not
  /// measured, or steps so far from line to line that it may have gone either way round. rad/s.
  std::vector<Interval> doubtful_bands;
  Interval measured_band;  ///< rad/s; in it the noise leaves the phase known within 30 degrees, up to doubtful bands
  std::vector<Remark> remarks;  ///< outside the band, poor coherence, a loop that is unstable at once
};

/// Finds every -180 degree crossing of P(e^{jwT}) between its points, and the least stiffness among those that poles
/// leave by.
///
///     Im P(e^{jwT}) = 0, Re P < 0, K = -1 / Re P        (eq. 23 of Díaz & Gil)
///
/// A crossing counts as proven where the lines on either side of it, as many as it takes, differ from -180 degrees by
/// 4 standard deviations taken together: a noisy crossing is one crossing, and hundreds of lines bring no false one.
/// A line's standard deviation is what its variance says or how far it stands off its neighbours, whichever is larger.
/// Intervals are those of a straight line through the phases and magnitudes around the crossing.
/// Outside the measured band nothing is known, and a crossover there may be lower: said in the remarks, always. A phase
/// already past -180 degrees where the band begins proves that the limiting one lies below it: not_in_band.
/// Requires sampling_period and at least two points; throws Error (invalid_argument) otherwise.
[[nodiscard]] MeasuredStiffness measured_stiffness(const FrequencyResponse& response);

/// The 95 % interval of the critical stiffness: the least of the crossovers that poles leave by, each within its own
/// interval. Absent unless found.
[[nodiscard]] std::optional<Interval> stiffness_interval(const MeasuredStiffness& measured);

}  // namespace zwidth
