#include "identification/further_body.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "identification/fit_comparison.hpp"
#include "identification/fit_judgement.hpp"
#include "identification/link_mode.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

/// A fifth of a body on a link to the rest of it, with their mode at w: the last body and the last link.
DeviceParameters with_further_body(DeviceParameters device, std::size_t at, double w) {
  device.uncertainty.reset();
  constexpr double share = 0.2;
  constexpr double lightest = 0.001;  // of the critical damping
  Body further{"further"};
  const auto is_taken = [&] {
    return std::ranges::find(device.bodies, further.name, &Body::name) != device.bodies.end();
  };
  while (is_taken()) further.name += "_";
  further.mass = share * device.bodies[at].mass;
  device.bodies[at].mass -= further.mass;
  device.bodies.push_back(std::move(further));
  Link link{at, device.bodies.size() - 1};
  link.stiffness = w * w * reduced_mass(device, link);
  link.damping = link_damping(device, link, lightest);
  device.links.push_back(link);
  return device;
}

std::string mass_key(const Body& body) { return fmt::format("body.{}.mass", body.name); }

/// The numbers of the fit, the further body's mass, and its link's stiffness and damping.
std::vector<std::string> free_with(const DeviceParameters& start, const Identification& result) {
  std::vector<std::string> free = keys_of(result.fit);
  free.push_back(mass_key(start.bodies.back()));
  for (const char* what : {"stiffness", "damping"}) {
    free.push_back(fmt::format("link.{}.{}", start.links.size() - 1, what));
  }
  return free;
}

/// The structure of the fit with the numbers beside the further body, whose mass is that of the body it hangs on.
DeviceParameters merged(const Device& further, const Identification& result) {
  DeviceParameters device = result.fit.device.parameters();
  device.uncertainty.reset();
  const Link& link = further.links().back();
  for (const std::string& key : keys_of(result.fit)) {
    double value = parameter(further.parameters(), key).value_or(0.0);
    if (key == mass_key(further.bodies()[link.first])) value += further.bodies().back().mass;
    set_parameter(device, key, value);
  }
  return device;
}

}  // namespace

std::optional<FurtherBody> find_further_body(const Identification& result, const IdentifyOptions& options) {
  if (options.scrutiny == IdentifyOptions::Scrutiny::of_fit || !result.trust.sound() || !result.fit.misfit)
    return std::nullopt;
  const DeviceParameters& fitted = result.fit.device.parameters();
  const double highest = result.fit.frequencies.back();
  std::vector<DeviceParameters> starts;
  for (std::size_t i = 0; i < fitted.bodies.size(); ++i) {
    if (std::ranges::count(options.fit.locked, fitted.bodies[i].name) > 0) continue;
    for (const double above : {1.3, 3.0}) starts.push_back(with_further_body(fitted, i, above * highest));
  }
  std::vector<std::optional<ParameterFit>> fits(starts.size());
  tbb::parallel_for(std::size_t{0}, starts.size(), [&](std::size_t i) {
    auto fit = fitted_from(starts[i], free_with(starts[i], result), result, options);
    if (fit && explains_notably_more(*fit, result.fit, result.response)) fits[i] = std::move(fit);
  });
  const ParameterFit* best = nullptr;
  for (const std::optional<ParameterFit>& each : fits) {
    if (each && (!best || explains_more(*each, *best))) best = &*each;
  }
  if (!best) return std::nullopt;
  auto anew = fitted_from(merged(best->device, result), keys_of(result.fit), result, options);
  const bool is_better = anew && explains_notably_more(*anew, result.fit, result.response);
  return FurtherBody{*best, is_better ? std::optional(std::move(anew->device)) : std::nullopt};
}

Finding doubt_of_further_body(const FurtherBody& further, const Identification& result) {
  const Device& device = further.fit.device;
  const Link& link = device.links().back();
  const Body& body = device.bodies()[link.first];
  const double mode = std::sqrt(link.stiffness / reduced_mass(device.parameters(), link));
  return {.code = FindingCode::higher_order_explains_better,
          .evidence = {{"frequency", hertz(mode)}, {"residual", *further.fit.misfit}, {"without", *result.fit.misfit}},
          .subjects = {{"body", body.name}}};
}

}  // namespace zwidth::internal
