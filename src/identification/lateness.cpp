#include "identification/lateness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "model/uncertainty_problem.hpp"

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

Remark ignored_delay_remark(double shown, double given) {
  return {Remark::Severity::warning,
          fmt::format("the record shows a delay of {:.3g} s where the structure has {:.3g} s", shown, given),
          "the critical stiffness depends on it", "free loop.delay, or give it"};
}

}  // namespace zwidth::internal
