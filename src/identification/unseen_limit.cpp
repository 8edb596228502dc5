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

/// Whether a fit with one number given leaves no more than chance may.
bool explains_as_much(const ParameterFit& given, const ParameterFit& free, double line_correlation) {
  if (!given.misfit || !free.misfit) return false;
  constexpr double chance = 4.0;  // of chi-squared, in the residuals' own size
  const double independent = 2.0 * static_cast<double>(free.frequencies.size()) / line_correlation;
  const double ratio = *given.misfit / *free.misfit;
  return given.model_error <= 1.02 * free.model_error + 1e-9 && (ratio * ratio - 1.0) * independent <= chance;
}

constexpr double well_known = 0.2;  // deviations of the value: what is known better moves K_CR as the draws show

/// What of the device limits elsewhere.
struct UnseenLimit {
  std::string known;  ///< of which number, how well
  CriticalStiffness critical;
};

/// One number at either end of its 95 % interval.
std::optional<UnseenLimit> at_an_end(const Device& device, const ParameterEstimate& each, const auto& limits) {
  const auto& uncertainty = device.parameters().uncertainty;
  const auto at = std::ranges::find(uncertainty->parameters, each.key);
  if (at == uncertainty->parameters.end() || !each.standard_deviation) return std::nullopt;
  if (*each.standard_deviation <= well_known * each.value) return std::nullopt;
  if (*each.standard_deviation > each.value) return std::nullopt;  // the draws show what having none of it does
  for (const double deviations : {-1.96, 1.96}) {
    const auto other = moved(device, static_cast<std::size_t>(at - uncertainty->parameters.begin()), deviations);
    if (!other) continue;
    CriticalStiffness critical = limit_of(*other);
    if (!limits(critical)) continue;
    return UnseenLimit{
        fmt::format("{} is known to {:.2g} % only", each.key, 100.0 * *each.standard_deviation / each.value),
        std::move(critical)};
  }
  return std::nullopt;
}

/// A link's damping that the data hardly show, or not at all, as low as links have it, and the others fitted again.
std::optional<UnseenLimit> with_little_damping(const Identification& result, const IdentifyOptions& options,
                                               const ParameterEstimate& each, const auto& limits) {
  constexpr double little = 0.01;  // of the critical one
  DeviceParameters parameters = result.fit.device.parameters();
  parameters.uncertainty.reset();
  for (std::size_t i = 0; i < parameters.links.size(); ++i) {
    Link& link = parameters.links[i];
    if (each.key != fmt::format("link.{}.damping", i)) continue;
    const double first = parameters.bodies[link.first].mass;
    const double second = parameters.bodies[link.second].mass;
    const double damping = 2.0 * little * std::sqrt(link.stiffness * first * second / (first + second));
    if (each.value <= damping) return std::nullopt;
    link.damping = damping;
    ParameterFitOptions fit_options = options.fit;
    fit_options.start = ParameterFitOptions::Start::from_structure;
    fit_options.free.clear();
    for (const ParameterEstimate& other : result.fit.estimates) {
      if (other.key != each.key) fit_options.free.push_back(other.key);
    }
    try {
      const ParameterFit fit = fit_parameters(Device(parameters), result.response, fit_options);
      if (!explains_as_much(fit, result.fit, result.response.line_correlation)) return std::nullopt;
      CriticalStiffness critical = limit_of(fit.device);
      if (!limits(critical)) return std::nullopt;
      return UnseenLimit{fmt::format("{} hardly shows", each.key), std::move(critical)};
    } catch (const Error&) {  // no device has such numbers
      return std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace

void judge_unseen_limit(Identification& result, const IdentifyOptions& options, Trust device_trust) {
  const DeviceParameters& parameters = result.fit.device.parameters();
  if (!result.trust.sound() || !parameters.uncertainty || !result.analysis.interval) return;
  const std::vector<double>& lines = result.fit.frequencies;
  const double lower = result.analysis.interval->lower;
  const auto limits = [&](const CriticalStiffness& critical) {
    constexpr double notable = 0.9;
    return critical.limit && critical.stiffness < notable * lower &&
           (critical.limit->frequency < lines.front() || critical.limit->frequency > lines.back());
  };
  for (const ParameterEstimate& each : result.fit.estimates) {
    auto unseen = at_an_end(result.fit.device, each, limits);
    if (!unseen && !(each.standard_deviation && *each.standard_deviation <= well_known * each.value)) {
      unseen = with_little_damping(result, options, each, limits);
    }
    if (!unseen) continue;
    const double frequency = unseen->critical.limit->frequency;
    const bool is_above = frequency > lines.back();
    result.trust.doubt(fmt::format(
        "{}: within that a crossover near {:.4g} Hz, {} the measured band, may limit at {:.4g} {}; excite {} frequencies",
        unseen->known, hertz(frequency), is_above ? "above" : "below", unseen->critical.stiffness,
        units_of(parameters.motion).stiffness, is_above ? "higher" : "lower"));
    result.analysis.trust.inherit(result.trust);
    device_trust.inherit(result.trust);
    result.fit.device = with_trust(result.fit.device, device_trust);
    return;
  }
}

}  // namespace zwidth::internal
