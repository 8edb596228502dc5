#include "zwidth/study/study_run.hpp"

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "counted.hpp"
#include "study/study_parts.hpp"
#include "thread_arena.hpp"
#include "zwidth/error.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr std::uint64_t most_side_samples = std::uint64_t{1} << 24U;
constexpr std::uint64_t least_index_samples = 16;  // fewer tell no error of an index

std::optional<OptionProblem> find_specification_problem(const char* member, std::optional<double> value) {
  if (!value || (std::isfinite(*value) && *value > 0.0)) return std::nullopt;
  return option_problem(std::string("specification.") + member,
                        {.code = ProblemCode::not_finite_and_positive, .evidence = {{"value", *value}}});
}

StudyOptions completed(StudyOptions options) {
  options.any_user = options.any_user || options.specification.any_user.has_value();
  return options;
}

const StudyDistributions& checked(const Device& device, const StudyDistributions& distributions,
                                  const StudyOptions& options) {
  if (const auto problem = find_problem(device, distributions)) {
    throw Error(ErrorCode::invalid_argument, fmt::format("{}: {}; {}", problem->key, problem->what, problem->allowed));
  }
  require_valid(find_problem(options, device, distributions));
  return distributions;
}

}  // namespace

std::optional<OptionProblem> find_problem(const StudyOptions& options, const Device& device,
                                          const StudyDistributions& distributions) {
  if (auto problem = SamplingPlan::find_problem(options.sampling, options.samples, distributions.parameters.size())) {
    return problem;
  }
  for (const auto& [member, value] : {std::pair{"index_samples", options.index_samples},
                                      std::pair{"tightening_samples", options.tightening_samples}}) {
    if (value > most_side_samples) {
      return option_problem(member, {.code = ProblemCode::too_many,
                                     .evidence = {counted("value", value), counted("most", most_side_samples)}});
    }
  }
  if (options.index_samples != 0 && options.index_samples < least_index_samples) {
    return option_problem("index_samples",
                          {.code = ProblemCode::count_out_of_range_or_zero,
                           .evidence = {counted("value", options.index_samples), counted("least", least_index_samples),
                                        counted("most", most_side_samples)}});
  }
  const Specification& wanted = options.specification;
  if (options.rare_samples != 0) {
    if (options.rare_samples < 100 || options.rare_samples > most_side_samples) {
      return option_problem("rare_samples", {.code = ProblemCode::count_out_of_range_or_zero,
                                             .evidence = {counted("value", options.rare_samples), counted("least", 100),
                                                          counted("most", most_side_samples)}});
    }
    if (!wanted.critical_stiffness && !wanted.any_user) {
      return option_problem("rare_samples", {.code = ProblemCode::no_specification});
    }
  }
  if (options.region_units != 0) {
    if (auto problem = find_region_problem(options.region_units, options.samples, device, distributions))
      return problem;
  }
  if (auto problem = find_specification_problem("critical_stiffness", wanted.critical_stiffness)) return problem;
  if (auto problem = find_specification_problem("any_user", wanted.any_user)) return problem;
  if ((options.any_user || wanted.any_user) && !device.is_mechanical()) {
    return option_problem(options.any_user ? "any_user" : "specification.any_user",
                          {.code = ProblemCode::asked_of_transfer_function});
  }
  return find_problem(BatchOptions{.threads = options.threads}, device);
}

StudyRun::StudyRun(Device device, const StudyDistributions& distributions, StudyOptions options)
    : device_(std::move(device)),
      distributions_(checked(device_, distributions, options)),
      options_(completed(options)),
      inputs_(distributions_),
      plan_(options.sampling, options.samples, distributions_.parameters.size(), options.seed) {}

std::uint64_t StudyRun::chunk_count() const { return (options_.samples + study_chunk_size - 1) / study_chunk_size; }

std::size_t StudyRun::size_of(std::uint64_t chunk) const {
  return static_cast<std::size_t>(std::min(study_chunk_size, options_.samples - chunk * study_chunk_size));
}

void StudyRun::values(std::uint64_t sample, std::span<double> values) const {
  for (std::size_t j = 0; j < values.size(); ++j) values[j] = plan_.uniform(sample, j);
  inputs_.from_uniform(values);
}

std::vector<double> StudyRun::independent_scores(std::uint64_t sample) const {
  std::vector<double> scores(inputs_.size());
  for (std::size_t j = 0; j < scores.size(); ++j) scores[j] = standard_normal_score(plan_.uniform(sample, j));
  return scores;
}

void StudyRun::scores(std::uint64_t sample, std::span<double> scores) const {
  std::ranges::copy(independent_scores(sample), scores.begin());
  inputs_.correlate(scores);
}

std::vector<ParameterValues> StudyRun::columns(std::uint64_t chunk) const {
  return columns(chunk * study_chunk_size, size_of(chunk));
}

std::vector<ParameterValues> StudyRun::columns(std::uint64_t first, std::size_t count) const {
  std::vector<ParameterValues> columns;
  for (const StudyParameter& each : distributions_.parameters)
    columns.push_back({each.key, std::vector<double>(count)});
  std::vector<double> row(columns.size());
  for (std::size_t i = 0; i < count; ++i) {
    values(first + i, row);
    for (std::size_t j = 0; j < row.size(); ++j) columns[j].values[i] = row[j];
  }
  return columns;
}

BatchStiffness StudyRun::answers(std::uint64_t chunk, const Progress& progress) const {
  return batch_stiffness(device_, columns(chunk), {.any_user = options_.any_user, .threads = 1}, progress);
}

BatchStiffness StudyRun::answers(const std::vector<ParameterValues>& columns, bool any_user,
                                 const Progress& progress) const {
  return batch_stiffness(device_, columns, {.any_user = any_user, .threads = options_.threads}, progress);
}

bool StudyRun::meets(const BatchStiffness& answers, std::size_t i) const {
  const Specification& wanted = options_.specification;
  // NaN, of a unit without an answer, reaches nothing.
  return (!wanted.critical_stiffness || answers.stiffness[i] >= *wanted.critical_stiffness) &&
         (!wanted.any_user || answers.any_user[i] >= *wanted.any_user);
}

void compute_chunks(const StudyRun& run, const std::function<std::optional<std::uint64_t>()>& next,
                    const std::function<void(std::uint64_t, BatchStiffness)>& consume, const Progress& within) {
  struct Computed {
    std::uint64_t chunk = 0;
    BatchStiffness answers;
  };
  const auto named = [&](tbb::flow_control& flow) -> std::uint64_t {
    if (const auto chunk = next()) return *chunk;
    flow.stop();
    return 0;
  };
  const auto computed = [&](std::uint64_t chunk) { return Computed{chunk, run.answers(chunk, within)}; };
  const auto consumed = [&](Computed one) { consume(one.chunk, std::move(one.answers)); };
  ThreadArena arena(run.options().threads);
  arena.execute([&] {
    const auto in_work = 2 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) + 2;
    tbb::parallel_pipeline(in_work,
                           tbb::make_filter<void, std::uint64_t>(tbb::filter_mode::serial_in_order, named) &
                               tbb::make_filter<std::uint64_t, Computed>(tbb::filter_mode::parallel, computed) &
                               tbb::make_filter<Computed, void>(tbb::filter_mode::serial_in_order, consumed));
  });
}

}  // namespace zwidth
