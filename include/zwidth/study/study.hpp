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
#include "zwidth/study/rare_failures.hpp"
#include "zwidth/study/sample_statistics.hpp"
#include "zwidth/study/sobol_indices.hpp"
#include "zwidth/study/study_distributions.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

struct StudyOptions {
  std::uint64_t samples = 10'000;
  std::uint64_t seed = 1;
  /// Random samples alone make the intervals hold as they say; the others make the same numbers vary less.
  SamplingScheme sampling = SamplingScheme::random;
  Specification specification = {};
  bool any_user = false;  ///< the limit over all passive users too, much slower; so it is where a specification has it
  std::uint64_t index_samples = 1024;         ///< of each set of Sobol indices; 0: none
  std::uint64_t tightening_samples = 10'000;  ///< on which a tighter tolerance is tried, `samples` at most; 0: none
  std::uint64_t rare_samples = 0;             ///< importance sampling of failures with so many units; 0: none
  bool worst = true;                          ///< search for the worst device
  std::size_t threads = 0;                    ///< 0: all cores. No result depends on it
};

/// Checks: samples and parameters as SamplingPlan; index_samples and tightening_samples at most 2^24; rare_samples 0 or 100 to
/// 2^24, with a specification; a specification
/// finite and > 0, of any user for bodies alone; threads.
[[nodiscard]] std::optional<OptionProblem> find_problem(const StudyOptions& options, const Device& device,
                                                        const StudyDistributions& distributions);

/// A quantile of K_CR over the units: X_(ceil(N p)), and the samples between which the true one lies (95 %).
struct QuantileEstimate {
  double probability = 0.0;
  double value = 0.0;           ///< infinity: unbounded there; NaN: a unit without an answer
  std::optional<double> lower;  ///< absent: too few samples to say
  std::optional<double> upper;
};

/// Counts of finite K_CR between edges, evenly apart.
struct StiffnessHistogram {
  std::vector<double> edges;  ///< one more than counts; empty where no unit has a finite K_CR
  std::vector<std::uint64_t> counts;
  std::vector<double> yields;  ///< at every edge: the share of all units that reach it
};

/// Units that miss the specification in one way.
struct FailureCluster {
  StiffnessStatus status = StiffnessStatus::finite;
  std::optional<Mechanism> limited_by;  ///< what limits K_CR; nothing unless finite
  std::uint64_t count = 0;
  double share = 0.0;                      ///< of all failures
  std::optional<double> lowest_frequency;  ///< rad/s, of their oscillation
  std::optional<double> highest_frequency;
  /// By parameter: the mean of its normal score there; 0 among all units. What these units have in common.
  std::vector<double> mean_scores;
};

/// What halving the spread of one parameter about the device's own value would gain.
struct TighteningGain {
  double yield_gain = 0.0;  ///< of the share that meets the specification
  double error = 0.0;       ///< its standard error
};

/// The least stable unit that the distributions hold.
///
/// Searched where they do: a parameter with ends and without correlation goes to its ends; the others together stay
/// within the ball of normal scores outside of which one unit in `outside` lies.
struct WorstDevice {
  DeviceParameters device;
  std::vector<double> values;  ///< by parameter
  CriticalStiffness critical;
  std::optional<double> any_user;  ///< its limit over all passive users, where the study asks for it
  double sampled = 0.0;            ///< the least K_CR among the samples
  double outside = 1e-6;
  std::uint64_t evaluations = 0;  ///< devices that the search solved
};

/// A unit that has no answer, and why. It counts as one that misses the specification.
struct FailedSample {
  std::uint64_t sample = 0;
  std::string reason;
};

/// One unit of the scatter: what it is and what it can.
struct StudyPoint {
  std::uint64_t sample = 0;
  std::vector<double> values;
  double stiffness = 0.0;  ///< NaN where failed, infinity where unbounded
  int mode = -1;           ///< as BatchStiffness
  StiffnessStatus status = StiffnessStatus::refused;
};

struct Study {
  std::vector<std::string> keys;  ///< of the parameters
  std::uint64_t samples = 0;
  /// Units that meet the whole specification, and each half; absent where nothing is specified.
  std::optional<Proportion> yield;
  std::optional<Proportion> critical_stiffness_yield;
  std::optional<Proportion> any_user_yield;
  std::vector<QuantileEstimate> quantiles;
  std::vector<QuantileEstimate> any_user_quantiles;  ///< empty unless asked for
  /// 95 % of all units reach it, with 95 % confidence (Wilks); absent with less than 59 samples.
  std::optional<double> reached_by_95_percent;
  StiffnessHistogram histogram;
  std::uint64_t none_stable = 0;
  std::uint64_t unbounded = 0;
  std::uint64_t doubtful = 0;
  std::uint64_t failed_count = 0;
  std::vector<FailedSample> failed;                       ///< the first 1000
  std::vector<FailureCluster> clusters;                   ///< largest first; empty without a specification
  std::optional<std::vector<SobolIndex>> sobol_indices;   ///< by parameter; absent where a remark says why
  std::optional<std::vector<TighteningGain>> tightening;  ///< by parameter; absent without a specification
  std::optional<RareFailures> rare_failures;              ///< absent unless asked for
  std::optional<WorstDevice> worst;
  std::vector<StudyPoint> points;  ///< of at most 2000 samples, evenly apart
  std::uint64_t scalar_count = 0;  ///< samples that critical_stiffness(Device) answered, not the batch kernel
  Trust trust;
  std::vector<Remark> remarks;
};

/// How K_CR varies over the units of one design.
///
/// The i-th unit depends on device, distributions, sampling, seed and i alone; every result is the same, bit for bit, for
/// any number of threads. A unit that cannot be computed is counted as one that misses the specification, and listed.
/// Throws Error (invalid_argument) where find_problem() of the distributions or of the options finds one.
[[nodiscard]] Study study(const Device& device, const StudyDistributions& distributions, const StudyOptions& options,
                          const Progress& progress = {});

}  // namespace zwidth
