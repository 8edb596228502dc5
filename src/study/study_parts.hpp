#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/progress.hpp"
#include "zwidth/study/study_run.hpp"

namespace zwidth::internal {

/// A unit from which the search for the worst one starts.
struct LowSample {
  double limit = 0.0;
  std::uint64_t sample = 0;
};

/// What one pass over all chunks, and three more, find.
struct CountedChunks {
  Study study;                           ///< yields, quantiles, histogram, clusters, failures, points
  std::vector<LowSample> lows;           ///< the lowest K_CR, lowest first
  std::vector<LowSample> any_user_lows;  ///< the lowest limits of any user, where they are asked for
};
[[nodiscard]] CountedChunks count_chunks(const StudyRun& run, const ChunkSource& chunks, const Progress& progress);

/// Which limit the worst unit has least of.
enum class SearchedLimit { critical, any_user };

/// Descends from the lowest samples, and from ends of the distributions, on exact sensitivities. Nothing where no unit
/// has a limit.
[[nodiscard]] std::optional<WorstDevice> find_worst(const StudyRun& run, const std::vector<LowSample>& lows,
                                                    SearchedLimit searched, const Progress& progress);

/// Of StudyOptions::region_units, which is not 0.
[[nodiscard]] std::optional<OptionProblem> find_region_problem(std::uint64_t units, std::uint64_t samples,
                                                               const Device& device,
                                                               const StudyDistributions& distributions);

/// Why the unit has no answer.
[[nodiscard]] std::string reason_of(const BatchStiffness& answers, std::size_t i);

/// Sobol indices of K_CR; a remark instead where they do not exist.
void add_indices(const StudyRun& run, Study& study, const Progress& progress);

/// What half the spread of each parameter gains.
void add_tightening(const StudyRun& run, Study& study, const Progress& progress);

}  // namespace zwidth::internal
