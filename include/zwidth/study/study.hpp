#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/holding.hpp"
#include "zwidth/study/rare_failures.hpp"
#include "zwidth/study/region_contours.hpp"
#include "zwidth/study/sample_statistics.hpp"
#include "zwidth/study/sobol_indices.hpp"
#include "zwidth/study/study_distributions.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// As study() keeps in memory, 2 to 3 GB of them; with StudyRun they are kept elsewhere.
inline constexpr std::uint64_t most_samples_in_memory = 50'000'000;

/// How many units, drawn how, and what they must reach.
struct StudyOptions {
  std::uint64_t samples = 10'000;  ///< how many units are drawn
  std::uint64_t seed = 1;          ///< of all that is drawn
  /// Random samples alone make the intervals hold as they say; the others make the same numbers vary less.
  SamplingScheme sampling = SamplingScheme::random;
  Specification specification = {};  ///< what a unit must reach
  bool any_user = false;  ///< the limit over all passive users too, much slower; so it is where a specification has it
  std::uint64_t index_samples = 1024;         ///< of each set of Sobol indices; 0: none
  std::uint64_t tightening_samples = 10'000;  ///< on which a tighter tolerance is tried, `samples` at most; 0: none
  std::uint64_t rare_samples = 0;             ///< importance sampling of failures with so many units; 0: none
  /// The walls that 99 %, 50 % and 1 % of the first so many units render, see region_contours(); 0: not asked.
  std::uint64_t region_units = 0;
  bool worst = true;        ///< search for the worst device
  std::size_t threads = 0;  ///< 0: all cores. No result depends on it
};

/// Checks: samples and parameters as SamplingPlan; index_samples 0 or 16 to 2^24; tightening_samples at most 2^24;
/// rare_samples 0 or 100 to 2^24, with a specification; region_units 0 or as region_contours(); a specification finite
/// and > 0, of any user for bodies alone; threads.
[[nodiscard]] std::optional<OptionProblem> find_problem(const StudyOptions& options, const Device& device,
                                                        const StudyDistributions& distributions);

/// A quantile of K_CR over the units: X_(ceil(N p)), and the samples between which the true one lies (95 %).
struct QuantileEstimate {
  double probability = 0.0;  ///< share of units below
  /// Infinity: unbounded there; NaN: a unit without an answer; absent where an end of the interval is.
  std::optional<double> value;
  std::optional<double> lower;  ///< of its 95 % interval; absent: too few samples to say
  std::optional<double> upper;  ///< of its 95 % interval; absent: too few samples to say
};

/// Counts of finite K_CR between edges, evenly apart.
struct StiffnessHistogram {
  std::vector<double> edges;          ///< one more than counts; empty where no unit has a finite K_CR
  std::vector<std::uint64_t> counts;  ///< of units, bin by bin
  std::vector<double> yields;         ///< at every edge: the share of all units that reach it
};

/// Units that miss the specification in one way.
struct FailureCluster {
  StiffnessStatus status = StiffnessStatus::finite;  ///< that they have in common
  std::optional<Oscillator> limited_by;              ///< what limits K_CR; nothing unless finite
  std::uint64_t count = 0;                           ///< how many
  double share = 0.0;                                ///< of all failures
  std::optional<double> lowest_frequency;            ///< rad/s, of their oscillation
  std::optional<double> highest_frequency;           ///< rad/s, of their limits
  /// By parameter: the mean of its normal score there; 0 among all units. What these units have in common.
  std::vector<double> mean_scores;
};

/// What halving the spread of one parameter about the device's own value would gain.
struct TighteningGain {
  double yield_gain = 0.0;  ///< of the share that meets the specification
  double error = 0.0;       ///< its standard error, as if one unit more had changed sides: never 0
};

/// The least stable unit that the distributions hold.
///
/// Searched where they do: a parameter with ends and without correlation goes to its ends; the others together stay
/// within the ball of normal scores outside of which one unit in `outside` lies. Descents from many places each end in a
/// local minimum; doubtful where only one of them came to this one.
struct WorstDevice {
  DeviceParameters device;         ///< as a file has it
  std::vector<double> values;      ///< by parameter
  CriticalStiffness critical;      ///< of that device
  std::optional<double> any_user;  ///< its limit over all passive users, where the study asks for it
  double sampled = 0.0;            ///< the least limit among the samples
  double outside = 1e-6;           ///< share of units that are farther out
  std::uint64_t evaluations = 0;   ///< devices that the search solved
  std::size_t descents = 0;        ///< from how many places it went down
  std::size_t agreeing = 0;        ///< how many of them ended at this limit
  Trust trust;                     ///< that it is the worst: of the device, its limit and the search
};

/// A unit that has no answer, and why. It counts as one that misses the specification.
struct FailedSample {
  std::uint64_t sample = 0;  ///< its number
  std::string reason;        ///< in words
};

/// One unit of the scatter: what it is and what it can.
struct StudyPoint {
  std::uint64_t sample = 0;                           ///< its number
  std::vector<double> values;                         ///< of the parameters, in their order
  double stiffness = 0.0;                             ///< NaN where failed, infinity where unbounded
  int mode = -1;                                      ///< as BatchStiffness
  StiffnessStatus status = StiffnessStatus::refused;  ///< of its limit
};

/// How the limit varies over the units of one design.
struct Study {
  std::vector<std::string> keys;  ///< of the parameters
  std::uint64_t samples = 0;      ///< units drawn
  /// Limits of the device as its file has it, with nobody and with its user; NaN where there is no answer. The units'
  /// limits are with its user where there is one, else with nobody.
  HoldingLimits limits;
  /// Units that meet the whole specification, and each half; absent where nothing is specified.
  std::optional<Proportion> yield;
  std::optional<Proportion> critical_stiffness_yield;          ///< absent unless specified
  std::optional<Proportion> absolute_stability_yield;          ///< absent unless specified
  std::vector<QuantileEstimate> quantiles;                     ///< of the critical stiffness
  std::vector<QuantileEstimate> absolute_stability_quantiles;  ///< empty unless asked for
  /// 95 % of all units reach it, with 95 % confidence (Wilks); absent with less than 59 samples.
  std::optional<double> reached_by_95_percent;
  StiffnessHistogram histogram;                           ///< of the finite limits
  std::uint64_t none_stable = 0;                          ///< units that no wall suits
  std::uint64_t unbounded = 0;                            ///< units that every wall suits
  std::uint64_t doubtful = 0;                             ///< units whose own answer is doubtful
  std::uint64_t failed_count = 0;                         ///< units without an answer
  std::vector<FailedSample> failed;                       ///< the first 1000
  std::vector<FailureCluster> clusters;                   ///< largest first; empty without a specification
  std::optional<std::vector<SobolIndex>> sobol_indices;   ///< by parameter; absent where a remark says why
  std::optional<std::vector<TighteningGain>> tightening;  ///< by parameter; absent without a specification
  /// Which of them gains most, where that is more than two of its standard errors: the tolerance to tighten.
  std::optional<std::size_t> tighten_first;
  std::optional<RareFailures> rare_failures;  ///< absent unless asked for
  std::optional<RegionContours> regions;      ///< absent unless asked for
  std::optional<WorstDevice> worst;           ///< absent where no unit has a limit
  std::optional<WorstDevice> worst_any_user;  ///< by the limit of any user; absent unless asked for
  std::vector<StudyPoint> points;             ///< of at most 2000 samples, evenly apart
  std::uint64_t scalar_count = 0;  ///< samples that critical_stiffness(Device) answered, not the batch kernel
  Trust trust;                     ///< of the whole answer
  std::vector<Remark> remarks;     ///< what is worth knowing beside it
};

/// How K_CR varies over the units of one design.
///
/// The i-th unit depends on device, distributions, sampling, seed and i alone; every result is the same, bit for bit,
/// for any number of threads. A unit that cannot be computed is counted as one that misses the specification, and
/// listed.
/// Throws Error (invalid_argument) where find_problem() of the distributions or of the options finds one, and for more
/// than most_samples_in_memory.
[[nodiscard]] Study study(const Device& device, const StudyDistributions& distributions, const StudyOptions& options,
                          const Progress& progress = {});

}  // namespace zwidth
