#include "identification/lateness.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "model/uncertainty_problem.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::internal {

Device with_shared_lateness(const Device& device) {
  DeviceParameters parameters = device.parameters();
  const double late = parameters.loop.delay + parameters.actuator.time_constant;
  if (!parameters.uncertainty || !(late > 0.0)) return device;
  Uncertainty& uncertainty = *parameters.uncertainty;
  const auto place = [&](const char* key) {
    return static_cast<std::size_t>(std::ranges::find(uncertainty.parameters, std::string(key)) -
                                    uncertainty.parameters.begin());
  };
  const std::size_t delay = place(delay_key);
  std::size_t lag = place(lag_key);
  std::size_t count = uncertainty.parameters.size();
  if (delay == count) return device;
  auto& covariance = uncertainty.covariance;
  // Where the truth is at a bound, and half of the draws move off it to one side of K_CR, 5 % of the others are 2.5 % of
  // all: the normal distribution's 1.645 deviations instead of 1.960.
  constexpr double one_sided = 1.960 / 1.645;
  for (auto& row : covariance) {
    for (double& value : row) value *= one_sided * one_sided;
  }
  // Wherever the fit puts the difference, from -late to late, 2.5 % of the draws reach either end; none goes beyond.
  const double of_difference = 1.1 * late * late;
  if (lag == count) {
    if (count == max_uncertain_parameters) return device;
    uncertainty.parameters.emplace_back(lag_key);
    for (auto& row : covariance) row.push_back(0.0);
    covariance.emplace_back(++count, 0.0);
    const double shared = 0.25 * of_difference;
    covariance[delay][delay] += shared;
    covariance[lag][lag] += shared;
    covariance[delay][lag] = covariance[lag][delay] = -shared;
  } else {  // as if the difference had been measured so
    std::vector<double> with_difference;
    with_difference.reserve(count);
    for (const auto& row : covariance) with_difference.push_back(row[delay] - row[lag]);
    const double open = with_difference[delay] - with_difference[lag];
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        covariance[i][j] -= with_difference[i] * with_difference[j] / (open + of_difference);
      }
    }
    for (std::size_t i = 0; i < count; ++i) covariance[i][i] = std::max(covariance[i][i], 0.0);
  }
  uncertainty = without_rounding(std::move(uncertainty));
  return Device(std::move(parameters));
}

Device with_open_delay(const Device& device, double variance) {
  DeviceParameters parameters = device.parameters();
  if (!parameters.uncertainty) parameters.uncertainty.emplace();
  Uncertainty& uncertainty = *parameters.uncertainty;
  std::vector<std::string>& keys = uncertainty.parameters;
  const auto place = static_cast<std::size_t>(std::ranges::find(keys, std::string(delay_key)) - keys.begin());
  if (place == keys.size()) {
    if (keys.size() == max_uncertain_parameters) return device;
    keys.emplace_back(delay_key);
    for (auto& row : uncertainty.covariance) row.push_back(0.0);
    uncertainty.covariance.emplace_back(keys.size(), 0.0);
  }
  uncertainty.covariance[place][place] += variance;
  return Device(std::move(parameters));
}

std::optional<double> other_delay(const ParameterEstimate& estimate, const Loop& loop) {
  constexpr double significant = 4.0;
  constexpr double notable = 0.02;  // of the sampling period
  const double beyond = std::abs(estimate.value - loop.delay);
  if (!estimate.standard_deviation || beyond <= significant * *estimate.standard_deviation) return std::nullopt;
  if (beyond <= notable * loop.sampling_period) return std::nullopt;
  return estimate.value;
}

std::optional<Finding> doubt_of_lost_delay(const Device& structure, const std::vector<ParameterEstimate>& estimates) {
  const auto delay = std::ranges::find(estimates, std::string(delay_key), &ParameterEstimate::key);
  if (delay == estimates.end() || !delay->standard_deviation) return std::nullopt;
  const auto lag = std::ranges::find(estimates, std::string(lag_key), &ParameterEstimate::key);
  const double given_lag = structure.parameters().actuator.time_constant;
  const double given = structure.loop().delay + given_lag;
  const double shown = delay->value + (lag == estimates.end() ? given_lag : lag->value);
  constexpr double significant = 4.0;
  constexpr double notable = 0.1;  // of the sampling period
  const double lost = given - shown;
  if (lost <= significant * *delay->standard_deviation || lost <= notable * structure.loop().sampling_period) {
    return std::nullopt;
  }
  return Finding{.code = FindingCode::delay_lost, .evidence = {{"lost", lost, "s"}}, .key = delay_key};
}

Finding ignored_delay(double shown, double given) {
  return {.code = FindingCode::delay_contradicts_structure,
          .evidence = {{"shown", shown}, {"given", given}},
          .key = delay_key};
}

bool assumes_delay(const Device& structure, IdentifyOptions::StructureValues values,
                   IdentifyOptions::LoopDelay loop_delay) {
  const bool is_of_file = values == IdentifyOptions::StructureValues::known && structure.loop().delay > 0.0;
  return !is_of_file && loop_delay != IdentifyOptions::LoopDelay::as_given;
}

Finding hidden_delay(std::size_t lines, std::size_t numbers) {
  return {.code = FindingCode::delay_hidden,
          .evidence = {counted("lines", lines), counted("numbers", numbers)},
          .key = delay_key};
}

std::optional<Finding> doubt_of_open_delay(const Device& with, const Device& without) {
  const auto least = [](const Device& device) {
    const Analysis analysis = analyze(device, {.any_user = false});
    return analysis.interval ? analysis.interval->lower : 0.0;
  };
  constexpr double notable = 0.9;
  const double open = least(with);
  if (open >= notable * least(without)) return std::nullopt;
  return Finding{.code = FindingCode::delay_open,
                 .evidence = {{"stiffness", open}},
                 .subjects = {{"unit", std::string(units_of(with.parameters().motion).stiffness)}},
                 .key = delay_key,
                 .effect = {{"critical_stiffness", open}}};
}

Finding limit_outside_band(double limiting, double lowest, double highest) {
  return {.code = FindingCode::limit_outside_band,
          .evidence = {{"frequency", hertz(limiting)}, {"lowest", hertz(lowest)}, {"highest", hertz(highest)}},
          .subjects = {{"side", limiting > highest ? "above" : "below"}}};
}

}  // namespace zwidth::internal
