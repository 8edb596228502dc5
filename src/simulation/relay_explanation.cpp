#include "simulation/relay_explanation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "counted.hpp"
#include "simulation/loop_schedule.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

constexpr double agrees_db = 0.5;
/// A relay's square wave on a lightly damped rigid device slows its oscillation by 9 % against the crossover, the
/// sampling by a little more.
constexpr double near = 1.15;
constexpr double same_branch = 1.5;  // ratio of frequencies beyond which a first-harmonic cycle is another one

bool is_near(double frequency, double other) { return frequency <= near * other && other <= near * frequency; }

bool is_same_branch(double frequency, double other) {
  return frequency <= same_branch * other && other <= same_branch * frequency;
}

std::vector<Evidence> at(double frequency, double stiffness) {
  return {{"frequency_hz", hertz(frequency)}, {"stiffness_db", decibels(stiffness)}};
}

/// The element whose frequency is nearest, by ratio; null where there is none.
template <typename Cycle>
const Cycle* nearest(const std::vector<Cycle>& cycles, double frequency) {
  const Cycle* found = nullptr;
  for (const Cycle& each : cycles) {
    if (each.frequency <= 0.0) continue;
    const auto distance = [&](const Cycle& cycle) { return std::abs(std::log(cycle.frequency / frequency)); };
    if (!found || distance(each) < distance(*found)) found = &each;
  }
  return found;
}

Finding beside_crossover(const RelayMean& mean, const CriticalStiffness& linear) {
  const Crossover* crossover = nearest(linear.crossovers, mean.frequency);
  if (!crossover) return {.code = FindingCode::no_linear_crossover};
  Finding finding{.code = FindingCode::oscillates_off_crossovers,
                  .evidence = at(crossover->frequency, crossover->stiffness)};
  if (crossover->limited_by.kind != Oscillator::Kind::rigid_body) {
    finding.evidence.push_back({"mode", static_cast<double>(crossover->limited_by.mode)});
  }
  if (is_near(mean.frequency, crossover->frequency)) {
    const double difference = decibels(mean.stiffness / crossover->stiffness);
    finding.code = difference < 0.0 ? FindingCode::reads_less_at_crossover : FindingCode::reads_more_at_crossover;
    finding.evidence.push_back({"difference_db", std::abs(difference)});
  }
  return finding;
}

Finding beside_limit(const RelayResult& result) {
  const CriticalStiffness& linear = result.prediction->linear;
  if (result.limit_reading == LimitReading::none) return {.code = FindingCode::no_linear_limit};
  Finding finding{.evidence = at(linear.limit->frequency, linear.stiffness)};
  finding.evidence.push_back({"difference_db", std::abs(decibels(result.mean->stiffness / linear.stiffness))});
  switch (result.limit_reading) {
    case LimitReading::none:
      finding.code = FindingCode::no_linear_limit;
      break;
    case LimitReading::confirms:
      finding.code = FindingCode::reading_confirms_limit;
      break;
    case LimitReading::coincides:
      finding.code = FindingCode::reading_coincides_with_limit;
      break;
    case LimitReading::unsafe:
      finding.code = FindingCode::reading_above_limit;
      break;
    case LimitReading::too_cautious:
      finding.code = FindingCode::reading_below_limit;
      break;
  }
  return finding;
}

std::optional<Finding> by_friction(const RelayResult& result, const RelayMean& mean) {
  const double level = result.friction_level.value_or(0.0);
  if (level == 0.0) return std::nullopt;
  Finding finding{.code = FindingCode::friction_leaves_no_cycle};
  const LimitCycle* cycle = nearest(result.prediction->describing_function, mean.frequency);
  if (cycle && is_same_branch(mean.frequency, cycle->frequency)) {
    const Crossover* crossover = nearest(result.prediction->linear.crossovers, mean.frequency);
    const bool is_moved = crossover && !is_near(cycle->frequency, crossover->frequency);
    finding.code = is_moved ? FindingCode::friction_moves_cycle : FindingCode::friction_leaves_cycle;
    finding.evidence = at(cycle->frequency, cycle->stiffness);
    if (!is_near(mean.frequency, cycle->frequency)) finding.evidence.push_back({"harmonics", 1.0});
  }
  finding.evidence.push_back({"level", level});
  return finding;
}

std::string bands_text(const std::vector<CycleBand>& bands) {
  static constexpr std::size_t most = 6;
  std::string text;
  for (std::size_t i = 0; i < bands.size() && i < most; ++i) {
    const CycleBand& band = bands[i];
    text += i == 0 ? "" : ", ";
    text += band.count == 1
                ? number(hertz(band.lowest.frequency))
                : fmt::format("{} to {}", number(hertz(band.lowest.frequency)), number(hertz(band.highest.frequency)));
  }
  return text + (bands.size() > most ? ", ..." : "");
}

/// How closely frequencies are known, rad/s.
double resolution_of(const RelayResult& result) {
  double spacing = 0.0;
  for (const RelayTrial& trial : result.trials) {
    if (trial.result) spacing = std::max(spacing, trial.result->line_spacing);
  }
  return spacing;
}

Finding beside_sampled_relay(const RelayResult& result, const RelayMean& mean) {
  const std::vector<LimitCycle>& cycles = result.prediction->sampled_relay;
  if (cycles.empty()) {
    return {.code = FindingCode::sampled_relay_without_oscillation,
            .evidence = {{"lowest_hz", hertz(result.prediction->lowest_frequency)}}};
  }
  const LimitCycle* cycle = nearest(cycles, mean.frequency);
  const bool is_one = std::abs(mean.frequency - cycle->frequency) <= resolution_of(result);
  const bool rubs = result.friction_level.value_or(0.0) > 0.0;
  return {.code = is_one ? FindingCode::sampled_relay_has_this_one
                  : rubs ? FindingCode::sampled_relay_apart_by_friction
                         : FindingCode::sampled_relay_apart_by_switches,
          .evidence = {counted("cycles", cycles.size())},
          .subjects = {{"bands", bands_text(cycle_bands(cycles))}}};
}

}  // namespace

bool agree(const RelayMean& mean) { return is_near(mean.lowest_frequency, mean.highest_frequency); }

std::string oscillations_text(const RelayResult& result) {
  std::vector<const RelayReading*> readings;
  for (const RelayTrial& trial : result.trials) {
    if (trial.result) readings.push_back(&*trial.result);
  }
  std::ranges::sort(readings, {}, &RelayReading::frequency);
  const auto range = [](double lowest, double highest, const auto& text) {
    return text(lowest) == text(highest) ? text(lowest) : text(lowest) + " to " + text(highest);
  };
  const auto in_hertz = [](double frequency) { return number(hertz(frequency)); };
  const auto in_units = [&](double stiffness) { return quantity(stiffness, units_of(result.motion).stiffness); };
  std::string all;
  for (auto first = readings.begin(); first != readings.end();) {
    const auto end = std::find_if(first, readings.end(), [&](const RelayReading* each) {
      return !is_near((*first)->frequency, each->frequency);
    });
    const auto [softest, stiffest] =
        std::minmax_element(first, end, [](const auto* a, const auto* b) { return a->stiffness < b->stiffness; });
    const auto count = end - first;
    all += all.empty() ? "" : end == readings.end() ? " and " : ", ";
    all += fmt::format("{} Hz ({}, {} trial{})", range((*first)->frequency, (*(end - 1))->frequency, in_hertz),
                       range((*softest)->stiffness, (*stiffest)->stiffness, in_units), count, count == 1 ? "" : "s");
    first = end;
  }
  return all;
}

LimitReading limit_reading(const RelayMean& mean, const CriticalStiffness& linear) {
  if (!linear.limit || linear.limit->frequency <= 0.0) return LimitReading::none;
  const double difference = decibels(mean.stiffness / linear.stiffness);
  if (std::abs(difference) <= agrees_db) {
    return is_near(mean.frequency, linear.limit->frequency) ? LimitReading::confirms : LimitReading::coincides;
  }
  return difference > 0.0 ? LimitReading::unsafe : LimitReading::too_cautious;
}

std::vector<Finding> relay_explanation(const RelayResult& result) {
  if (!result.mean) {
    return {{.code = FindingCode::trials_at_different_oscillations,
             .subjects = {{"oscillations", oscillations_text(result)}}}};
  }
  const RelayMean& mean = *result.mean;
  std::vector<Finding> findings{beside_crossover(mean, result.prediction->linear), beside_limit(result)};
  if (result.device && damper_runs_apart(*result.device)) return findings;  // no other prediction is whole
  if (std::optional<Finding> friction = by_friction(result, mean)) findings.push_back(*std::move(friction));
  findings.push_back(beside_sampled_relay(result, mean));
  return findings;
}

}  // namespace zwidth::internal
