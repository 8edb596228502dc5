#include "identification/unseen_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "identification/fit_judgement.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

/// Parameter i at `deviations` of its own from the fit, the others where the data then put them: C_ji / C_ii per unit.
std::optional<Device> moved(const Device& device, std::size_t i, double deviations) {
  DeviceParameters parameters = device.parameters();
  const Uncertainty uncertainty = *std::exchange(parameters.uncertainty, {});
  const double variance = uncertainty.covariance[i][i];
  for (std::size_t j = 0; j < uncertainty.parameters.size(); ++j) {
    const std::string& key = uncertainty.parameters[j];
    const double value = parameter(parameters, key).value_or(0.0);
    const bool is_mass = key.ends_with(".mass");
    constexpr double least_mass = 0.1;  // of its value
    const double lowest = is_mass ? least_mass * value : 0.0;
    set_parameter(parameters, key,
                  std::max(lowest, value + deviations * uncertainty.covariance[j][i] / std::sqrt(variance)));
  }
  try {
    return Device(std::move(parameters));
  } catch (const Error&) {  // no device has such numbers
    return std::nullopt;
  }
}

}  // namespace

void judge_unseen_limit(Identification& result, Trust device_trust) {
  const auto& uncertainty = result.fit.device.parameters().uncertainty;
  if (!result.trust.sound() || !uncertainty || !result.analysis.interval) return;
  const std::vector<double>& lines = result.fit.frequencies;
  for (const ParameterEstimate& each : result.fit.estimates) {
    constexpr double well_known = 0.2;  // deviations of the value: what is known better moves K_CR as the draws show
    const auto at = std::ranges::find(uncertainty->parameters, each.key);
    if (at == uncertainty->parameters.end() || !each.standard_deviation) continue;
    if (*each.standard_deviation <= well_known * each.value) continue;
    if (*each.standard_deviation > each.value) continue;  // many of the draws have none of it: they show what it does
    for (const double deviations : {-1.96, 1.96}) {
      const auto i = static_cast<std::size_t>(at - uncertainty->parameters.begin());
      const std::optional<Device> device = moved(result.fit.device, i, deviations);
      if (!device) continue;
      const CriticalStiffness critical = limit_of(*device);
      constexpr double notable = 0.9;
      if (!critical.limit || critical.stiffness >= notable * result.analysis.interval->lower) continue;
      const double frequency = critical.limit->frequency;
      if (frequency >= lines.front() && frequency <= lines.back()) continue;
      const bool is_above = frequency > lines.back();
      result.trust.doubt(fmt::format(
          "{} is known to {:.2g} % only: within that a crossover near {:.4g} Hz, {} the measured band, may limit at "
          "{:.4g} {}; excite {} frequencies",
          each.key, 100.0 * *each.standard_deviation / each.value, hertz(frequency), is_above ? "above" : "below",
          critical.stiffness, units_of(device->parameters().motion).stiffness, is_above ? "higher" : "lower"));
      result.analysis.trust.inherit(result.trust);
      device_trust.inherit(result.trust);
      result.fit.device = with_trust(result.fit.device, device_trust);
      return;
    }
  }
}

}  // namespace zwidth::internal
