#include "identification/held_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

bool is_on_springs(const DeviceParameters& device) {
  return device.user.stiffness > 0.0 ||
         std::ranges::any_of(device.bodies, [](const Body& body) { return body.stiffness > 0.0; });
}

std::optional<Remark> remark_of_operator(const Device& structure) {
  const User& user = structure.parameters().user;
  if (user.mass == 0.0 && user.damping == 0.0 && user.stiffness == 0.0) return std::nullopt;
  return warning({.code = FindingCode::operator_taken_to_hold, .key = "operator"});
}

}  // namespace

std::vector<Remark> remarks_of_experiment(const Device& structure, bool is_known,
                                          const std::vector<std::string>& locked) {
  std::vector<Remark> remarks;
  if (auto remark = remark_of_operator(structure)) {
    remarks.push_back(*std::move(remark));
  } else if (!is_known && locked.empty()) {
    remarks.push_back(note({.code = FindingCode::nobody_taken_to_hold}));
  }
  if (!is_known) remarks.push_back(note({.code = FindingCode::force_taken_for_command}));
  return remarks;
}

std::optional<Finding> doubt_of_hand(const Device& structure, const std::vector<ParameterEstimate>& estimates,
                                     const std::vector<std::string>& locked) {
  if (!structure.has_bodies() || !locked.empty()) return std::nullopt;
  const Body& held = structure.bodies()[structure.loop().held];
  const auto ratio = [&](const char* number, double known) {
    const auto found =
        std::ranges::find(estimates, fmt::format("body.{}.{}", held.name, number), &ParameterEstimate::key);
    if (found == estimates.end() || !found->lower || !(known > 0.0)) return 0.0;
    return *found->lower / known;
  };
  const double of_mass = ratio("mass", held.mass);
  const double of_damping = ratio("damping", held.damping);
  constexpr double heavier = 1.1;
  constexpr double more_damped = 1.3;
  constexpr double together = 2.2;
  if (!(of_mass > heavier && of_damping > more_damped && of_mass * of_damping > together)) return std::nullopt;
  return Finding{.code = FindingCode::held_body_looks_held,
                 .evidence = {{"of_mass", of_mass}, {"of_damping", of_damping}, {"threshold", together}},
                 .subjects = {{"body", held.name}},
                 .key = fmt::format("body.{}.mass", held.name)};
}

std::optional<double> missing_spring(const RecordFit& fit, const ParameterFitOptions& options) {
  constexpr double clear = 0.005;
  if (!options.locked.empty() || fit.fit.model_error < clear || fit.response.points.empty()) return std::nullopt;
  DeviceParameters parameters = fit.fit.device.parameters();
  if (is_on_springs(parameters)) return std::nullopt;
  parameters.uncertainty.reset();
  Body& held = parameters.bodies[parameters.loop.held];
  held.stiffness = 1.0 / std::abs(fit.response.points.front().value);
  ParameterFitOptions wider = options;
  wider.start = ParameterFitOptions::Start::from_structure;
  wider.search_widely = false;
  wider.critical_point = ParameterFitOptions::CriticalPoint::free;
  wider.free.clear();
  for (const ParameterEstimate& each : fit.fit.estimates) wider.free.push_back(each.key);
  wider.free.push_back(fmt::format("body.{}.stiffness", held.name));
  try {
    const ParameterFit found = fit_parameters(Device(std::move(parameters)), fit.response, wider);
    const ParameterEstimate& spring = found.estimates.back();
    constexpr double much_better = 0.5;
    constexpr double deviations = 5.0;
    const bool shows = spring.standard_deviation && spring.value > deviations * *spring.standard_deviation;
    if (!shows || found.model_error > much_better * fit.fit.model_error) return std::nullopt;
    return spring.value;
  } catch (const Error&) {  // too few points, or no such fit
    return std::nullopt;
  }
}

}  // namespace zwidth::internal
