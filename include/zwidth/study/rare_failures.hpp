#pragma once

#include <cstdint>
#include <vector>

#include "zwidth/progress.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

class StudyRun;

/// How a small share is estimated.
struct RareFailureOptions {
  std::uint64_t samples = 20'000;  ///< units drawn around the likeliest failures; 100 to 2^24
};

/// A unit on the border of failure that is likelier than its neighbours, as independent standard normal numbers.
struct DesignPoint {
  std::vector<double> scores;  ///< standard normal ones of the point, one per parameter
  double distance = 0.0;  ///< from the middle, in standard deviations: the failures beyond have about Phi(-distance)
};

/// The share of units that miss the specification, where sampling as it is would see none.
struct RareFailures {
  double share = 0.0;  ///< 0 where no failure was found: trust is doubtful then
  double error = 0.0;  ///< its standard error
  double lower = 0.0;  ///< lower end of its 95 % interval, see weighted_sum_interval()
  /// Upper end of that interval; where no failure was found, what 2048 units as they are leave possible.
  double upper = 0.0;
  std::uint64_t evaluations = 0;    ///< devices computed
  std::vector<DesignPoint> points;  ///< nearest first
  Trust trust;                      ///< of the share
};

/// Importance sampling around the likeliest failures.
///
/// Units are independent standard normal numbers y. Failures are looked for with twice and three times their spread;
/// from the nearest, and from the middle, iteration of Hasofer, Lind, Rackwitz and Fiessler goes to the nearest border
///
///     y <- (g' y - g) g / |g|²,    g = grad K_CR
///
/// Then y is drawn from q = 0.1 N(0, 1) + 0.9 sum w_k N(y_k, 1), and the share is the mean of 1{fails} phi(y)/q(y). Half
/// of the centres' weight has the border's places, half 64 failures that two rounds of 2048 pilot units found,
/// resampled by phi/q: where failures lie wider than places of a border tell, they are drawn as wide. Doubtful where
/// failures that were not found could matter: few effective samples, or one that weighs much; and where units have no
/// answer or a doubtful one. Every unit without an answer fails. The same for any number of threads.
/// Throws Error (invalid_argument) for a study without a specification and for samples out of range.
/// Sources: R. Rackwitz, B. Fiessler, Comput. Struct. 9, 489 (1978); O. Ditlevsen, H. O. Madsen, Structural Reliability
/// Methods, 1996, chapters 5 and 9.
[[nodiscard]] RareFailures rare_failures(const StudyRun& run, const RareFailureOptions& options = {},
                                         const Progress& progress = {});

}  // namespace zwidth
