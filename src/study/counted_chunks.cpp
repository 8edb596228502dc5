#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "staged_progress.hpp"
#include "study/study_parts.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t most_failed = 1000;
constexpr std::size_t most_points = 2000;
constexpr std::size_t most_lows = 12;
constexpr std::size_t bins = 80;
constexpr double infinity = std::numeric_limits<double>::infinity();

const std::vector<double> probabilities = {0.001, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.999};

/// The first pass: everything but the order of the numbers.
class Counter {
 public:
  explicit Counter(const StudyRun& run) : run_(run), row_(run.inputs().size()) {
    for (const StudyParameter& each : run.distributions().parameters) study_.keys.push_back(each.key);
    study_.samples = run.options().samples;
    study_.trust = trust_of(run.device());  // with its findings, which answers in bytes have not
    stride_ = (study_.samples + most_points - 1) / most_points;
    any_user_ = run.options().specification.any_user.has_value();
    specified_ = any_user_ || run.options().specification.critical_stiffness.has_value();
  }

  void add(std::uint64_t chunk, const BatchStiffness& answers) {
    study_.trust.inherit(answers.trust);
    study_.scalar_count += answers.scalar_count;
    for (std::size_t i = 0; i < answers.size(); ++i) add(chunk * study_chunk_size + i, answers, i);
  }

  [[nodiscard]] Study study() && {
    const auto share = [&](std::uint64_t count) { return proportion(count, study_.samples); };
    const Specification& wanted = run_.options().specification;
    if (specified_) study_.yield = share(meeting_);
    if (wanted.critical_stiffness) study_.critical_stiffness_yield = share(stiff_);
    if (wanted.any_user) study_.absolute_stability_yield = share(any_user_stiff_);
    for (auto& [what, cluster] : clusters_) {
      cluster.share = static_cast<double>(cluster.count) / static_cast<double>(study_.samples - meeting_);
      for (double& score : cluster.mean_scores) score /= static_cast<double>(cluster.count);
      study_.clusters.push_back(std::move(cluster));
    }
    std::ranges::stable_sort(study_.clusters, std::ranges::greater{}, &FailureCluster::count);
    return std::move(study_);
  }

  [[nodiscard]] std::vector<LowSample> lows() const { return lows_; }
  [[nodiscard]] std::vector<LowSample> any_user_lows() const { return any_user_lows_; }
  [[nodiscard]] double least() const { return least_; }
  [[nodiscard]] double largest() const { return largest_; }

 private:
  void add(std::uint64_t sample, const BatchStiffness& answers, std::size_t i) {
    const double stiffness = answers.stiffness[i];
    const StiffnessStatus status = answers.status[i];
    study_.none_stable += status == StiffnessStatus::none_stable ? 1U : 0U;
    study_.unbounded += status == StiffnessStatus::unbounded ? 1U : 0U;
    study_.doubtful += answers.verdict[i] == Trust::Verdict::doubtful && answers.trust.sound() ? 1U : 0U;
    const bool without_any_user = run_.options().any_user && std::isnan(answers.any_user[i]);
    if (std::isnan(stiffness) || without_any_user) fail(sample, answers, i);
    if (std::isfinite(stiffness) && status == StiffnessStatus::finite) {
      least_ = std::min(least_, stiffness);
      largest_ = std::max(largest_, stiffness);
    }
    keep_if_low(sample, stiffness, lows_);
    if (run_.options().any_user) keep_if_low(sample, answers.any_user[i], any_user_lows_);
    if (sample % stride_ == 0) {
      run_.values(sample, row_);
      study_.points.push_back({sample, row_, stiffness, answers.mode[i], status});
    }
    if (!specified_) return;
    const Specification& wanted = run_.options().specification;
    stiff_ += wanted.critical_stiffness && stiffness >= *wanted.critical_stiffness ? 1U : 0U;
    any_user_stiff_ += any_user_ && answers.any_user[i] >= *wanted.any_user ? 1U : 0U;
    if (run_.meets(answers, i)) {
      ++meeting_;
    } else {
      miss(sample, answers, i);
    }
  }

  void fail(std::uint64_t sample, const BatchStiffness& answers, std::size_t i) {
    if (++study_.failed_count > most_failed) return;
    study_.failed.push_back({sample, reason_of(answers, i)});
  }

  static void keep_if_low(std::uint64_t sample, double limit, std::vector<LowSample>& lows) {
    if (std::isnan(limit) || (lows.size() == most_lows && !(limit < lows.back().limit))) return;
    const auto place = std::ranges::upper_bound(lows, limit, {}, &LowSample::limit);
    lows.insert(place, {limit, sample});
    if (lows.size() > most_lows) lows.pop_back();
  }

  void miss(std::uint64_t sample, const BatchStiffness& answers, std::size_t i) {
    FailureCluster& cluster = clusters_[{static_cast<int>(answers.status[i]), answers.mode[i]}];
    if (cluster.count++ == 0) {
      cluster.status = answers.status[i];
      cluster.limited_by = answers.limited_by(i);
      cluster.mean_scores.assign(row_.size(), 0.0);
    }
    if (cluster.limited_by) {
      const double frequency = answers.frequency[i];
      cluster.lowest_frequency = std::min(cluster.lowest_frequency.value_or(frequency), frequency);
      cluster.highest_frequency = std::max(cluster.highest_frequency.value_or(frequency), frequency);
    }
    run_.scores(sample, row_);
    for (std::size_t j = 0; j < row_.size(); ++j) cluster.mean_scores[j] += row_[j];
  }

  const StudyRun& run_;
  std::vector<double> row_;
  Study study_;
  std::uint64_t stride_ = 1;
  bool any_user_ = false;
  bool specified_ = false;
  std::uint64_t meeting_ = 0;
  std::uint64_t stiff_ = 0;
  std::uint64_t any_user_stiff_ = 0;
  std::map<std::pair<int, int>, FailureCluster> clusters_;
  std::vector<LowSample> lows_;
  std::vector<LowSample> any_user_lows_;
  double least_ = infinity;
  double largest_ = -infinity;
};

/// Whether the doubles are the same column of K_CR or of the absolute stability limit.
using Column = std::vector<double> BatchStiffness::*;

struct Quantiles {
  std::vector<QuantileEstimate> estimates;
  std::optional<double> reached_by_95_percent;
};

Quantiles quantiles_of(const StudyRun& run, const ChunkSource& chunks, Column column) {
  const std::uint64_t samples = run.options().samples;
  std::vector<std::uint64_t> ranks;
  const auto wanted = [&](std::uint64_t rank) {
    ranks.push_back(rank);
    return ranks.size() - 1;
  };
  struct Places {
    std::size_t value = 0;
    std::optional<std::size_t> lower;
    std::optional<std::size_t> upper;
  };
  std::vector<Places> places;
  for (const double p : probabilities) {
    const auto rank = static_cast<std::uint64_t>(std::ceil(p * static_cast<double>(samples)));
    const QuantileRanks between = quantile_ranks(p, samples);
    Places& place = places.emplace_back();
    place.value = wanted(std::clamp<std::uint64_t>(rank, 1, samples));
    if (between.lower) place.lower = wanted(*between.lower);
    if (between.upper) place.upper = wanted(*between.upper);
  }
  std::optional<std::size_t> reached;
  if (const auto rank = tolerance_rank(0.95, 0.95, samples)) reached = wanted(*rank);
  const std::vector<double> values = order_statistics(ranks, [&](const std::function<void(double)>& take) {
    for (std::uint64_t chunk = 0; chunk < run.chunk_count(); ++chunk) {
      for (const double value : chunks(chunk).*column) take(value);
    }
  });
  Quantiles quantiles;
  for (std::size_t i = 0; i < places.size(); ++i) {
    QuantileEstimate& estimate = quantiles.estimates.emplace_back();
    estimate.probability = probabilities[i];
    if (places[i].lower && places[i].upper) estimate.value = values[places[i].value];
    if (places[i].lower) estimate.lower = values[*places[i].lower];
    if (places[i].upper) estimate.upper = values[*places[i].upper];
  }
  if (reached) quantiles.reached_by_95_percent = values[*reached];
  return quantiles;
}

StiffnessHistogram histogram_of(const StudyRun& run, const ChunkSource& chunks, double least, double largest) {
  StiffnessHistogram histogram;
  if (!(least <= largest)) return histogram;
  const double width = largest > least ? (largest - least) / static_cast<double>(bins) : 0.0;
  const std::size_t count = width > 0.0 ? bins : 1;
  for (std::size_t i = 0; i <= count; ++i) histogram.edges.push_back(least + width * static_cast<double>(i));
  histogram.edges.back() = largest;
  histogram.counts.assign(count, 0);
  std::uint64_t unbounded = 0;
  std::uint64_t stiffest = 0;
  for (std::uint64_t chunk = 0; chunk < run.chunk_count(); ++chunk) {
    const BatchStiffness& answers = chunks(chunk);
    for (std::size_t i = 0; i < answers.size(); ++i) {
      unbounded += answers.status[i] == StiffnessStatus::unbounded ? 1U : 0U;
      if (answers.status[i] != StiffnessStatus::finite) continue;
      // The last edge at or below, by the edges themselves: a share at an edge is exact.
      const auto above = std::ranges::upper_bound(histogram.edges, answers.stiffness[i]) - histogram.edges.begin();
      ++histogram.counts[std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(above, 1)) - 1, count - 1)];
      stiffest += answers.stiffness[i] == largest ? 1U : 0U;
    }
  }
  std::uint64_t reaching = unbounded;
  histogram.yields.assign(count + 1, 0.0);
  const auto all = static_cast<double>(run.options().samples);
  histogram.yields[count] = static_cast<double>(reaching + stiffest) / all;
  for (std::size_t i = count; i-- > 0;) {
    reaching += histogram.counts[i];
    histogram.yields[i] = static_cast<double>(reaching) / all;
  }
  return histogram;
}

/// What stays without an answer is NaN: the units tell why.
void add_nominal_limits(const Device& device, Study& study) {
  try {
    study.limits.nobody = limit_of_holder(critical_stiffness(device_without_user(device)));
    if (device_has_user(device)) study.limits.user = limit_of_holder(critical_stiffness(device));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
  }
  if (!study.limits.user) return;
  const auto unit = units_of(device.parameters().motion).stiffness;
  const double alone = study.limits.nobody.critical_stiffness;
  if (!(alone < study.limits.user->critical_stiffness)) return;
  study.remarks.push_back(warning({.code = FindingCode::study_with_user,
                                   .evidence = {{"nobody_limit", alone, unit}},
                                   .key = "operator",
                                   .effect = {{"critical_stiffness", alone}}}));
}

}  // namespace

std::string reason_of(const BatchStiffness& answers, std::size_t i) {
  std::string reason = answers.failure_of(i);
  return reason.empty() ? fmt::format("refused: {}", fmt::join(answers.trust_of(i).reasons, "; ")) : reason;
}

CountedChunks count_chunks(const StudyRun& run, const ChunkSource& chunks, const Progress& progress) {
  Counter counter(run);
  const std::uint64_t count = run.chunk_count();
  for (std::uint64_t chunk = 0; chunk < count; ++chunk) {
    counter.add(chunk, chunks(chunk));
    tell(progress, 0.3 * static_cast<double>(chunk + 1) / static_cast<double>(count));
  }
  const std::vector<LowSample> lows = counter.lows();
  const std::vector<LowSample> any_user_lows = counter.any_user_lows();
  const double least = counter.least();
  const double largest = counter.largest();
  CountedChunks counted{std::move(counter).study(), lows, any_user_lows};
  Study& study = counted.study;
  add_nominal_limits(run.device(), study);
  if (study.trust.refused()) {
    study.failed.clear();
    study.yield = study.critical_stiffness_yield = study.absolute_stability_yield = std::nullopt;
    study.clusters.clear();
    return counted;
  }
  Quantiles quantiles = quantiles_of(run, chunks, &BatchStiffness::stiffness);
  study.quantiles = std::move(quantiles.estimates);
  study.reached_by_95_percent = quantiles.reached_by_95_percent;
  tell(progress, 0.7);
  if (run.options().any_user) {
    study.absolute_stability_quantiles = quantiles_of(run, chunks, &BatchStiffness::any_user).estimates;
  }
  study.histogram = histogram_of(run, chunks, least, largest);
  return counted;
}

}  // namespace zwidth::internal
