#include "zwidth/study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "staged_progress.hpp"
#include "study/study_parts.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double at_the_end = 1e-9;  // of the width of a distribution

void judge(const StudyRun& run, Study& study) {
  const auto warning = [&](std::string what, std::string consequence, std::string remedy) {
    study.remarks.push_back({Remark::Severity::warning, std::move(what), std::move(consequence), std::move(remedy)});
  };
  if (study.failed_count > 0) {
    study.trust.doubt(
        fmt::format("{} of {} units have no answer ({}): they count as units that miss the specification; "
                    "keep the distributions away from such devices",
                    study.failed_count, study.samples, study.failed.front().reason));
  }
  if (study.doubtful > 0) {
    study.trust.doubt(fmt::format("the limits of {} of {} units are doubtful; see analyze of the worst device",
                                  study.doubtful, study.samples));
  }
  const auto& wanted = run.options().specification;
  if (!wanted.critical_stiffness && !wanted.any_user) {
    study.remarks.push_back({Remark::Severity::note, "nothing is specified", "there is no yield to state",
                             "give [specification] critical_stiffness"});
  }
  if (run.options().sampling != SamplingScheme::random) {
    study.remarks.push_back({Remark::Severity::note, "the samples are spread evenly, not drawn independently",
                             "the intervals of yield and quantiles are those of independent ones: wider than need be "
                             "as a rule, not by proof",
                             "sampling = \"random\" makes them hold"});
  }
  if (!study.reached_by_95_percent) {
    warning(fmt::format("{} samples say little about the tails", study.samples),
            "no bound of 95 % of the units can be stated with 95 % confidence",
            fmt::format("take {} or more", wilks_samples(0.95, 0.95)));
  }
}

/// Two answers to one question: the share of failures counted, and by importance sampling.
void judge_rare(Study& study) {
  RareFailures& rare = *study.rare_failures;
  const double least = 1.0 - study.yield->upper;
  const double most = 1.0 - study.yield->lower;
  if (rare.lower <= most && least <= rare.upper) return;
  rare.trust.doubt(
      fmt::format("the samples themselves say {:.3g} to {:.3g}: the search did not find every way to fail; take more "
                  "rare samples, or rely on the yield",
                  least, most));
}

}  // namespace

void internal::add_indices(const StudyRun& run, Study& study, const Progress& progress) {
  const StudyOptions& options = run.options();
  if (options.index_samples == 0) return;
  const std::size_t dimensions = run.inputs().size();
  const auto leave_out = [&](std::string why, std::string remedy) {
    study.remarks.push_back({Remark::Severity::note, "no Sobol indices: " + std::move(why), "", std::move(remedy)});
  };
  if (!run.distributions().correlation.empty()) {
    return leave_out("the parameters are correlated, and the variance cannot be shared out among them",
                     "leave [correlation] out to have them");
  }
  if (dimensions > most_index_dimensions) {
    return leave_out(fmt::format("there are more than {} parameters", most_index_dimensions), "");
  }
  if (study.failed_count > 0 || study.unbounded > 0) {
    return leave_out("some units have no finite limit", "");
  }
  bool is_finite = true;
  std::size_t doubtful = 0;
  std::size_t sets = 0;
  const auto answers = [&](const std::vector<std::vector<double>>& uniforms) {
    std::vector<ParameterValues> columns;
    for (std::size_t j = 0; j < dimensions; ++j) {
      columns.push_back({run.distributions().parameters[j].key, {}});
      for (const double u : uniforms[j]) columns.back().values.push_back(run.inputs().quantile(j)(u));
    }
    StagedProgress stages(progress);
    stages.next(static_cast<double>(sets++) / static_cast<double>(dimensions + 2));
    const BatchStiffness units = run.answers(columns, false, stages.stage());
    doubtful += units.exceptions.size();
    std::vector<double> stiffness = units.stiffness;
    for (double& value : stiffness) {
      if (std::isfinite(value)) continue;
      is_finite = false;
      value = 0.0;
    }
    return stiffness;
  };
  auto indices = sobol_indices(dimensions, options.index_samples, options.seed, answers);
  if (!is_finite) return leave_out("some units have no finite limit", "");
  const auto warning = [&](std::string what, std::string remedy) {
    study.remarks.push_back({Remark::Severity::warning, std::move(what),
                             "the Sobol indices are not to be relied on that far", std::move(remedy)});
  };
  if (doubtful > 0) {
    warning(fmt::format("the limits of {} of the units of the Sobol indices are doubtful", doubtful),
            "keep the distributions away from such devices");
  }
  const double worst_error = std::ranges::max(indices, {}, &SobolIndex::total_error).total_error;
  constexpr double much = 0.1;
  if (worst_error > much) {
    warning(fmt::format("a Sobol index is known to {:.2g} only", worst_error),
            fmt::format("take more index samples than {}", options.index_samples));
  }
  for (std::size_t i = 0; i < dimensions; ++i) {
    if (indices[i].total != 0.0) continue;
    study.remarks.push_back({Remark::Severity::note,
                             run.distributions().parameters[i].key + " changes no unit's critical stiffness",
                             "its tolerance can neither gain nor cost yield in that",
                             "leave it out, unless the limit for any user depends on it"});
  }
  study.sobol_indices = std::move(indices);
}

void internal::add_tightening(const StudyRun& run, Study& study, const Progress& progress) {
  const StudyOptions& options = run.options();
  const auto& parameters = run.distributions().parameters;
  const std::uint64_t count = std::min(options.samples, options.tightening_samples);
  if (count == 0 || !study.yield) return;
  std::vector<ParameterValues> columns = run.columns(0, static_cast<std::size_t>(count));
  const bool any_user = options.specification.any_user.has_value();
  StagedProgress stages(progress);
  const auto steps = static_cast<double>(parameters.size() + 1);
  stages.next(1.0 / steps);
  const BatchStiffness before = run.answers(columns, any_user, stages.stage());
  study.tightening.emplace();
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const QuantileFunction& quantile = run.inputs().quantile(j);
    double centre = parameter(run.device().parameters(), parameters[j].key).value_or(quantile(0.5));
    // An end itself is reached, though the numbers that are drawn stop just before it.
    const double end = at_the_end * (quantile.largest() - quantile.least());
    if (!(centre >= quantile.least() - end && centre <= quantile.largest() + end)) centre = quantile(0.5);
    const std::vector<double> wide = columns[j].values;
    for (double& value : columns[j].values) value = centre + 0.5 * (value - centre);
    stages.next(static_cast<double>(j + 2) / steps);
    const BatchStiffness after = run.answers(columns, any_user, stages.stage());
    columns[j].values = wide;
    double sum = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const double gain = static_cast<double>(run.meets(after, i)) - static_cast<double>(run.meets(before, i));
      sum += gain;
      square += gain * gain;
    }
    const auto n = static_cast<double>(count);
    const double mean = sum / n;
    study.tightening->push_back({mean, std::sqrt((std::max(0.0, square / n - mean * mean) + 1.0 / n) / n)});
  }
  constexpr double sure = 2.0;  // standard errors
  const auto best = std::ranges::max_element(*study.tightening, {}, &TighteningGain::yield_gain);
  if (best != study.tightening->end() && best->yield_gain > sure * best->error) {
    study.tighten_first = static_cast<std::size_t>(best - study.tightening->begin());
  }
}

Study summary(const StudyRun& run, const ChunkSource& chunks, const Progress& progress) {
  StagedProgress stages(progress);
  stages.next(0.5);
  auto [study, lows, any_user_lows] = count_chunks(run, chunks, stages.stage());
  study.trust.inherit(trust_of(run.device()));
  if (study.trust.refused()) return std::move(study);
  stages.next(0.65);
  add_indices(run, study, stages.stage());
  stages.next(0.75);
  add_tightening(run, study, stages.stage());
  stages.next(0.85);
  if (run.options().region_units > 0) {
    study.regions = region_contours(run, run.options().region_units, stages.stage());
  }
  stages.next(0.95);
  if (run.options().rare_samples > 0) {
    study.rare_failures = rare_failures(run, {.samples = run.options().rare_samples}, stages.stage());
    judge_rare(study);
  }
  stages.next(1.0);
  if (run.options().worst) {
    study.worst = find_worst(run, lows, SearchedLimit::critical, stages.stage());
    if (run.options().any_user) {
      study.worst_any_user = find_worst(run, any_user_lows, SearchedLimit::any_user, stages.stage());
    }
    for (std::optional<WorstDevice>* worst : {&study.worst, &study.worst_any_user}) {
      if (!*worst || study.failed_count == 0) continue;
      (*worst)->trust.doubt(fmt::format("{} units have no answer: one of them may be worse", study.failed_count));
    }
  }
  judge(run, study);
  stages.done();
  return std::move(study);
}

Study study(const Device& device, const StudyDistributions& distributions, const StudyOptions& options,
            const Progress& progress) {
  if (options.samples > most_samples_in_memory) {
    throw Error(ErrorCode::invalid_argument,
                fmt::format("samples is {}; at most {} are kept in memory", options.samples, most_samples_in_memory));
  }
  const StudyRun run(device, distributions, options);
  StagedProgress stages(progress);
  stages.next(0.8);
  std::vector<BatchStiffness> chunks;
  std::uint64_t named = 0;
  SharedProgress shared(stages.stage(), run.chunk_count());
  compute_chunks(
      run, [&] { return named < run.chunk_count() ? std::optional(named++) : std::nullopt; },
      [&](std::uint64_t, BatchStiffness answers) {
        chunks.push_back(std::move(answers));
        shared.add();
      },
      progress ? Progress([&](double) { shared.go_on(); }) : Progress());
  stages.next(1.0);
  return summary(
      run, [&](std::uint64_t chunk) -> const BatchStiffness& { return chunks[static_cast<std::size_t>(chunk)]; },
      stages.stage());
}

}  // namespace zwidth
