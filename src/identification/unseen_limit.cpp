#include "identification/unseen_limit.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "identification/fit_comparison.hpp"
#include "identification/fit_judgement.hpp"
#include "identification/link_mode.hpp"
#include "identification/misfit_doubt.hpp"
#include "stability/device_draws.hpp"
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

/// A limit where the record shows nothing.
struct UnseenLimit {
  Finding why;  ///< what the record leaves open
  CriticalStiffness critical;
};

/// The numbers of the fit but for those that stay.
std::vector<std::string> free_beside(const std::set<std::string>& kept, const Identification& result) {
  std::vector<std::string> free = keys_of(result.fit);
  std::erase_if(free, [&](const std::string& key) { return kept.contains(key); });
  return free;
}

/// Whether the data hardly show a number: what is known better moves K_CR as the draws show.
bool is_open(const ParameterEstimate& each) {
  constexpr double well_known = 0.2;  // deviations of the value
  return !each.standard_deviation || *each.standard_deviation > well_known * each.value;
}

/// One number towards either end of its 95 % interval, as far as others make up for it: that interval is one of slopes, and
/// at its ends numbers may be negative. The others are those that the data show, or all.
std::optional<UnseenLimit> at_an_end(const Device& device, const ParameterEstimate& each, const Identification& result,
                                     const IdentifyOptions& options, const auto& limits) {
  const auto& uncertainty = device.parameters().uncertainty;
  const auto at = std::ranges::find(uncertainty->parameters, each.key);
  if (at == uncertainty->parameters.end() || !each.standard_deviation || !is_open(each)) return std::nullopt;
  if (*each.standard_deviation > each.value) return std::nullopt;  // the draws show what having none of it does
  std::set<std::string> open;
  for (const ParameterEstimate& other : result.fit.estimates) {
    if (is_open(other)) open.insert(other.key);
  }
  for (const double deviations : {-1.96, 1.96, -1.8, 1.8, -1.6, 1.6, -1.3, 1.3, -0.8, 0.8}) {
    const auto other = moved(device, static_cast<std::size_t>(at - uncertainty->parameters.begin()), deviations);
    if (!other || !limits(limit_of(*other))) continue;
    for (const std::set<std::string>& kept : {open, {each.key}}) {
      const auto fit = fitted_from(other->parameters(), free_beside(kept, result), result, options);
      if (!fit || !explains_as_much(*fit, result.fit, result.response.line_correlation)) continue;
      CriticalStiffness critical = limit_of(fit->device);
      if (!limits(critical)) continue;
      return UnseenLimit{{.code = FindingCode::unseen_limit_within_interval,
                          .evidence = {{"relative_deviation", *each.standard_deviation / each.value}},
                          .key = each.key},
                         std::move(critical)};
    }
  }
  return std::nullopt;
}

/// A start, and the numbers that stay as they are in it.
struct HeldStart {
  DeviceParameters device;
  std::set<std::string> held;
};

/// A link with its mode at w, as lightly damped as hardly any joint is, in two divisions of the damping to ground: as it is,
/// and in proportion to the masses; and where a search from there ends. Far below the mode a record shows of a link from
/// m_1 to m_2 no more than the sum of the masses and (m_2 / (m_1 + m_2))^2 / k.
std::vector<HeldStart> light_modes(const DeviceParameters& fitted, std::size_t i, double w,
                                   const std::set<std::string>& free) {
  constexpr double lightest = 0.001;  // of the critical damping
  DeviceParameters light = fitted;
  light.uncertainty.reset();
  Link& link = light.links[i];
  double& first = light.bodies[link.first].mass;
  double& second = light.bodies[link.second].mass;
  const double sum = first + second;
  const double compliance = std::pow(second / sum, 2) / link.stiffness;
  first = sum / (1.0 + compliance * sum * w * w);
  second = sum - first;
  link.stiffness = w * w * reduced_mass(light, link);
  link.damping = std::min(link.damping, link_damping(light, link, lightest));
  const std::string key = fmt::format("link.{}", i);
  const std::set<std::string> held_link{key + ".damping", key + ".stiffness"};
  std::vector<HeldStart> starts{{light, {}}, {light, held_link}, {light, held_link}};
  double mass = 0.0;
  double damping = 0.0;
  for (const Body& body : light.bodies) {
    mass += body.mass;
    damping += body.damping;
  }
  auto& [evenly, held] = starts.back();
  for (std::size_t k = 0; k < evenly.bodies.size(); ++k) {
    Body& body = evenly.bodies[k];
    const std::string own = fmt::format("body.{}.damping", body.name);
    if (!free.contains(own)) continue;
    body.damping = damping * body.mass / mass;
    if (k > 0) held.insert(own);
  }
  return starts;
}

/// Where searches from elsewhere end.
struct Elsewhere {
  std::optional<CriticalStiffness> limit;  ///< the first that one comes to
  std::optional<ParameterFit> best;        ///< that explains the record best
};

/// Of those fits that may be the device.
Elsewhere searched_elsewhere(const std::vector<HeldStart>& starts, const Identification& result,
                             const IdentifyOptions& options, const auto& limits, const auto& may_be) {
  struct End {
    ParameterFit fit;
    CriticalStiffness critical;
  };
  std::vector<std::optional<End>> ends(starts.size());
  tbb::parallel_for(std::size_t{0}, starts.size(), [&](std::size_t i) {
    auto fit = fitted_from(starts[i].device, free_beside(starts[i].held, result), result, options);
    if (!fit || !may_be(*fit)) return;
    CriticalStiffness critical = limit_of(fit->device);
    ends[i] = {*std::move(fit), std::move(critical)};
  });
  Elsewhere elsewhere;
  for (std::optional<End>& end : ends) {
    if (!end) continue;
    if (!elsewhere.limit && limits(end->critical)) elsewhere.limit = std::move(end->critical);
    if (!elsewhere.best || explains_more(end->fit, *elsewhere.best)) elsewhere.best = std::move(end->fit);
  }
  return elsewhere;
}

/// Starts with a mode above the band of which the record shows neither the damping nor where it is.
std::vector<HeldStart> all_light_modes(const Identification& result) {
  const std::vector<std::string> keys = keys_of(result.fit);
  const std::set<std::string> free(keys.begin(), keys.end());
  const DeviceParameters& fitted = result.fit.device.parameters();
  const double highest = result.fit.frequencies.back();
  std::vector<HeldStart> starts;
  for (std::size_t i = 0; i < fitted.links.size(); ++i) {
    if (!free.contains(fmt::format("link.{}.damping", i))) continue;
    const Link& link = fitted.links[i];
    const Body& first = fitted.bodies[link.first];
    const Body& second = fitted.bodies[link.second];
    const double own = std::sqrt(link.stiffness / reduced_mass(fitted, link));
    const bool may_move = free.contains(fmt::format("link.{}.stiffness", i)) &&
                          free.contains(fmt::format("body.{}.mass", first.name)) &&
                          free.contains(fmt::format("body.{}.mass", second.name));
    std::vector<double> modes{own};
    for (const double above : {1.3, 2.0, 3.0, 4.5}) {
      if (may_move) modes.push_back(above * highest);
    }
    for (const double w : modes) {
      for (HeldStart& each : light_modes(fitted, i, w, free)) starts.push_back(std::move(each));
    }
  }
  return starts;
}

/// Numbers of devices with other values of what the data do not show to a factor of less than 2: masses, stiffnesses, delay and lag
/// by a factor, dampings of links from 0.5 to 10 % of the critical one, dampings to ground in other shares of their sum.
class OtherValues {
 public:
  explicit OtherValues(const Identification& result) : device_(result.fit.device.parameters()) {
    device_.uncertainty.reset();
    for (const ParameterEstimate& each : result.fit.estimates) {
      constexpr double shown = 0.5;
      if (!each.standard_deviation || *each.standard_deviation > shown * each.value) open_.insert(each.key);
    }
  }

  [[nodiscard]] bool exist() const { return !open_.empty(); }

  DeviceParameters next() {
    DeviceParameters other = device_;
    double mass = 0.0;
    double damping = 0.0;
    for (Body& body : other.bodies) {
      vary(body.mass, fmt::format("body.{}.mass", body.name));
      if (!is_open(fmt::format("body.{}.damping", body.name))) continue;
      damping += body.damping;
      body.damping = body.mass * factor();
      mass += body.damping;
    }
    for (Body& body : other.bodies) {
      if (is_open(fmt::format("body.{}.damping", body.name))) body.damping *= damping / mass;
    }
    for (std::size_t i = 0; i < other.links.size(); ++i) {
      Link& link = other.links[i];
      vary(link.stiffness, fmt::format("link.{}.stiffness", i));
      if (!is_open(fmt::format("link.{}.damping", i))) continue;
      link.damping = link_damping(other, link, 0.022 * std::pow(4.5, std::clamp(normal_.next(), -1.0, 1.0)));
    }
    vary(other.loop.delay, "loop.delay");
    vary(other.actuator.time_constant, "actuator.time_constant");
    return other;
  }

 private:
  [[nodiscard]] bool is_open(const std::string& key) const { return open_.contains(key); }
  double factor() { return std::exp(0.7 * normal_.next()); }
  void vary(double& value, const std::string& key) {
    if (is_open(key)) value *= factor();
  }

  DeviceParameters device_;
  std::set<std::string> open_;
  NormalDraws normal_{1};
};

/// Starts from other values of what is open.
std::vector<HeldStart> other_values(const Identification& result) {
  constexpr std::size_t many = 24;  // of 60 tried on one such record 17 came to another limit, none of the first 12
  OtherValues values(result);
  std::vector<HeldStart> starts;
  while (values.exist() && starts.size() < many) starts.push_back({values.next(), {}});
  return starts;
}

/// The device of a fit, all its numbers fitted anew, where the answer's fit cannot stand beside it.
std::optional<Device> better_device(const ParameterFit& fit, const Identification& result,
                                    const IdentifyOptions& options) {
  const auto is_better = [&](const ParameterFit& other) {
    return is_contradicted(result.fit, other, result.response.line_correlation);
  };
  if (is_rounding(result.fit, result.response) || !is_better(fit)) return std::nullopt;
  auto all = fitted_from(fit.device.parameters(), keys_of(result.fit), result, options);
  if (!all || !is_better(*all)) return std::nullopt;
  return std::move(all->device);
}

}  // namespace

std::optional<Device> judge_unseen_limit(Identification& result, const Device& as_fitted,
                                         const IdentifyOptions& options) {
  const DeviceParameters& parameters = as_fitted.parameters();
  if (options.scrutiny == IdentifyOptions::Scrutiny::of_fit) return std::nullopt;
  if (!result.trust.sound() || !parameters.uncertainty || !result.analysis.interval) return std::nullopt;
  const std::vector<double>& lines = result.fit.frequencies;
  const double lower = result.analysis.interval->lower;
  const auto limits = [&](const CriticalStiffness& critical) {
    constexpr double notable = 0.9;
    return critical.limit && critical.stiffness < notable * lower &&
           (critical.limit->frequency < lines.front() || critical.limit->frequency > lines.back());
  };
  std::optional<UnseenLimit> unseen;
  for (const ParameterEstimate& each : result.fit.estimates) {
    if (!unseen) unseen = at_an_end(as_fitted, each, result, options, limits);
  }
  const double correlation = result.response.line_correlation;
  const auto is_as_good = [&](const ParameterFit& fit) { return explains_as_much(fit, result.fit, correlation); };
  const auto may_be = [&](const ParameterFit& fit) { return !is_contradicted(fit, result.fit, correlation); };
  std::optional<Device> better;
  const auto look = [&](const std::vector<HeldStart>& starts, const auto& is_allowed, FindingCode why) {
    if (unseen || better) return;
    Elsewhere elsewhere = searched_elsewhere(starts, result, options, limits, is_allowed);
    if (elsewhere.best) better = better_device(*elsewhere.best, result, options);
    if (elsewhere.limit) unseen = UnseenLimit{{.code = why}, *std::move(elsewhere.limit)};
  };
  look(all_light_modes(result), may_be, FindingCode::unseen_limit_of_light_mode);
  look(other_values(result), is_as_good, FindingCode::unseen_limit_of_other_values);
  if (!unseen) return better;
  const double frequency = unseen->critical.limit->frequency;
  const bool is_above = frequency > lines.back();
  Finding found = std::move(unseen->why);
  found.evidence.push_back({"frequency", hertz(frequency)});
  found.evidence.push_back({"stiffness", unseen->critical.stiffness});
  found.subjects.push_back({"side", is_above ? "above" : "below"});
  found.subjects.push_back({"unit", std::string(units_of(parameters.motion).stiffness)});
  found.effect.push_back({"critical_stiffness", unseen->critical.stiffness});
  result.trust.doubt(std::move(found));
  return better;
}

}  // namespace zwidth::internal
