#include "identification/lateness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

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

std::optional<std::string> doubt_of_lost_delay(const Device& structure,
                                               const std::vector<ParameterEstimate>& estimates) {
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
  return fmt::format(
      "the record shows {} less delay than the structure states: rows that pair a force with a later position hide it, "
      "and the critical stiffness comes out too high; log both at one instant, or correct loop.delay in the structure",
      quantity(lost, "s"));
}

Remark ignored_delay_remark(double shown, double given) {
  return {Remark::Severity::warning,
          fmt::format("the record shows a delay of {:.3g} s where the structure has {:.3g} s", shown, given),
          "the critical stiffness depends on it", "free loop.delay, or give it"};
}

bool assumes_delay(const Device& structure, IdentifyOptions::StructureValues values,
                   IdentifyOptions::LoopDelay loop_delay) {
  const bool is_of_file = values == IdentifyOptions::StructureValues::known && structure.loop().delay > 0.0;
  return !is_of_file && loop_delay != IdentifyOptions::LoopDelay::as_given;
}

std::string hidden_delay_reason(std::size_t lines, std::size_t numbers) {
  return fmt::format(
      "the response has {} lines, too few to tell a delay beside the {} numbers that are fitted, and a delay makes the "
      "critical stiffness lower; excite more lines, or state loop.delay in a device file",
      lines, numbers);
}

std::optional<std::string> doubt_of_open_delay(const Device& with, const Device& without) {
  const auto least = [](const Device& device) {
    const Analysis analysis = analyze(device, {.any_user = false});
    return analysis.interval ? analysis.interval->lower : 0.0;
  };
  constexpr double notable = 0.9;
  const double open = least(with);
  if (open >= notable * least(without)) return std::nullopt;
  return fmt::format(
      "no delay was to be fitted, and the record does not exclude one with which the critical stiffness is {:.3g} {}; "
      "free loop.delay, state it in a device file, or excite higher frequencies",
      open, units_of(with.parameters().motion).stiffness);
}

std::string outside_band_reason(double limiting, double lowest, double highest) {
  const bool is_above = limiting > highest;
  return fmt::format(
      "the crossover that limits, near {:.4g} Hz, lies {} the measured band, {:.4g} to {:.4g} Hz: {}; excite {} "
      "frequencies",
      hertz(limiting), is_above ? "above" : "below", hertz(lowest), hertz(highest),
      is_above ? "delay, lag and modes there are not in the data" : "dampings and springs there are not in the data",
      is_above ? "higher" : "lower");
}

}  // namespace zwidth::internal
