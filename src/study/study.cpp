#include "zwidth/study/study.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "counted.hpp"
#include "model/known_structure.hpp"
#include "staged_progress.hpp"
#include "study/study_parts.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double at_the_end = 1e-9;  // of the width of a distribution

void judge(const StudyRun& run, Study& study) {
  if (study.failed_count > 0) {
    study.trust.doubt({.code = FindingCode::units_without_answer,
                       .evidence = {{"failed", static_cast<double>(study.failed_count)},
                                    {"samples", static_cast<double>(study.samples)}},
                       .subjects = {{"reason", study.failed.front().reason}}});
  }
  if (study.doubtful > 0) {
    study.trust.doubt({.code = FindingCode::unit_limits_doubtful,
                       .evidence = {{"doubtful", static_cast<double>(study.doubtful)},
                                    {"samples", static_cast<double>(study.samples)}}});
  }
  const auto& wanted = run.options().specification;
  if (!wanted.critical_stiffness && !wanted.any_user) {
    study.remarks.push_back(note({.code = FindingCode::nothing_specified}));
  }
  if (run.options().sampling != SamplingScheme::random) {
    study.remarks.push_back(note({.code = FindingCode::samples_spread_evenly}));
  }
  if (!study.reached_by_95_percent) {
    study.remarks.push_back(warning({.code = FindingCode::few_samples_for_tails,
                                     .evidence = {{"samples", static_cast<double>(study.samples)},
                                                  {"needed", static_cast<double>(wilks_samples(0.95, 0.95))}}}));
  }
}

/// Two answers to one question: the share of failures counted, and by importance sampling.
void judge_rare(Study& study) {
  RareFailures& rare = *study.rare_failures;
  const double least = 1.0 - study.yield->upper;
  const double most = 1.0 - study.yield->lower;
  if (rare.lower <= most && least <= rare.upper) return;
  rare.trust.doubt(
      {.code = FindingCode::rare_share_contradicts,
       .evidence = {{"least", least}, {"most", most}, {"rare_lower", rare.lower}, {"rare_upper", rare.upper}}});
}

}  // namespace

void internal::add_indices(const StudyRun& run, Study& study, const Progress& progress) {
  const StudyOptions& options = run.options();
  if (options.index_samples == 0) return;
  const std::size_t dimensions = run.inputs().size();
  const auto leave_out = [&](Finding why) { study.remarks.push_back(note(std::move(why))); };
  if (!run.distributions().correlation.empty()) {
    return leave_out({.code = FindingCode::no_indices_correlated});
  }
  if (dimensions > most_index_dimensions) {
    return leave_out({.code = FindingCode::no_indices_too_many_parameters,
                      .evidence = {{"parameters", static_cast<double>(dimensions)},
                                   {"most", static_cast<double>(most_index_dimensions)}}});
  }
  if (study.failed_count > 0 || study.unbounded > 0) {
    return leave_out({.code = FindingCode::no_indices_unbounded});
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
  if (!is_finite) return leave_out({.code = FindingCode::no_indices_unbounded});
  if (doubtful > 0) {
    study.remarks.push_back(warning(
        {.code = FindingCode::index_limits_doubtful, .evidence = {{"doubtful", static_cast<double>(doubtful)}}}));
  }
  const double worst_error = std::ranges::max(indices, {}, &SobolIndex::total_error).total_error;
  constexpr double much = 0.1;
  if (worst_error > much) {
    study.remarks.push_back(warning({.code = FindingCode::index_not_known,
                                     .evidence = {{"error", worst_error},
                                                  {"threshold", much},
                                                  {"index_samples", static_cast<double>(options.index_samples)}}}));
  }
  for (std::size_t i = 0; i < dimensions; ++i) {
    if (indices[i].total != 0.0) continue;
    const std::string& key = run.distributions().parameters[i].key;
    study.remarks.push_back(note({.code = FindingCode::parameter_without_effect, .key = key}));
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
      (*worst)->trust.doubt({.code = FindingCode::worse_may_have_no_answer,
                             .evidence = {{"failed", static_cast<double>(study.failed_count)}}});
    }
  }
  judge(run, study);
  stages.done();
  return std::move(study);
}

Study study(const Device& device, const StudyDistributions& distributions, const StudyOptions& options,
            const Progress& progress) {
  require_known_structure(device);
  if (options.samples > most_samples_in_memory) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::too_many_samples_in_memory,
                                              .evidence = {internal::counted("value", options.samples),
                                                           internal::counted("most", most_samples_in_memory)}});
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
