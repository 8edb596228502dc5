#include "report/device_region.hpp"

#include <algorithm>
#include <utility>

namespace zwidth::report {
namespace {

using Formula = RegionApproximation::Formula;

std::vector<ComparedApproximation> compared(const Device& device, const StableWalls& walls, const StableRegion& region,
                                            const std::optional<AnyUserRegion>& any_user) {
  std::vector<ComparedApproximation> result;
  for (RegionApproximation& formula : region_approximations(device, walls.velocity_filter_hz())) {
    if (formula.any_user && any_user) {
      result.push_back({formula, approximation_error(formula, *any_user)});
    } else if (!formula.any_user && region.most_damped) {
      result.push_back({formula, approximation_error(formula, walls, region.most_damped->damping)});
    }
  }
  return result;
}

}  // namespace

DeviceRegion device_region(Device device) {
  Analysis analysis = analyze(device, limit_and_wall_only());
  StableWalls walls(filtered_plant(device), device.parameters().wall.velocity_filter_hz);
  StableRegion region = stable_region(walls);
  std::optional<AnyUserRegion> any_user;
  if (device.has_bodies() && device.bodies().size() <= most_bodies_for_any_user && region.most_damped) {
    any_user = any_user_region(device, walls.velocity_filter_hz(), region.most_damped->damping);
  }
  std::vector<ComparedApproximation> approximations = compared(device, walls, region, any_user);
  return {{std::move(device), std::move(analysis)},
          std::move(walls),
          std::move(region),
          std::move(any_user),
          std::move(approximations)};
}

const char* formula_key(Formula formula) {
  switch (formula) {
    case Formula::colgate_schenkel:
      return "colgate_schenkel";
    case Formula::gil_hulin:
      return "gil_hulin";
    case Formula::diolaiti:
      break;
  }
  return "diolaiti";
}

std::string formula_name(Formula formula) {
  switch (formula) {
    case Formula::colgate_schenkel:
      return "Colgate & Schenkel";
    case Formula::gil_hulin:
      return "Gil, Hulin";
    case Formula::diolaiti:
      break;
  }
  return "Diolaiti";
}

const char* formula_source(Formula formula) {
  switch (formula) {
    case Formula::colgate_schenkel:
      return "Colgate & Schenkel 1997";
    case Formula::gil_hulin:
      return "Gil et al. 2007, Hulin et al.";
    case Formula::diolaiti:
      break;
  }
  return "Diolaiti et al. 2006";
}

const char* formula_text(Formula formula) {
  switch (formula) {
    case Formula::colgate_schenkel:
      return "b > K T/2 + B (1 - a)/(1 + a)";
    case Formula::gil_hulin:
      return "K < (b + B)/(T/2 + t_d)";
    case Formula::diolaiti:
      break;
  }
  return "K <= b/(T/2 + t_d), B = 0";
}

const char* formula_validity(Formula formula) {
  switch (formula) {
    case Formula::colgate_schenkel:
      return "rigid device, no delay, any passive user; exact there";
    case Formula::gil_hulin:
      return "rigid device, no other user, small delay, fast sampling, low damping; approximate";
    case Formula::diolaiti:
      break;
  }
  return "rigid device, no virtual damper, any passive user; exact for a delay of whole samples";
}

std::vector<std::string> unmet_assumptions(Formula formula, const Device& device) {
  const DeviceParameters& parameters = device.parameters();
  std::vector<std::string> unmet;
  if (!parameters.links.empty()) unmet.emplace_back("flexible links");
  const bool tied = std::any_of(parameters.bodies.begin(), parameters.bodies.end(),
                                [](const Body& body) { return body.stiffness > 0.0; });
  if (tied) unmet.emplace_back("springs to ground");
  if (parameters.actuator.time_constant > 0.0) unmet.emplace_back("an actuator lag");
  if (formula == Formula::colgate_schenkel && parameters.loop.delay > 0.0) unmet.emplace_back("a delay");
  if (formula == Formula::gil_hulin && parameters.wall.velocity_filter_hz > 0.0) {
    unmet.emplace_back("a velocity filter");
  }
  if (!parameters.wall.filters.empty()) unmet.emplace_back("filters in the wall");
  if (formula == Formula::gil_hulin && parameters.user.stiffness > 0.0) unmet.emplace_back("a user with stiffness");
  return unmet;
}

const char* boundary_key(BoundaryKind kind) {
  switch (kind) {
    case BoundaryKind::oscillation:
      return "oscillation";
    case BoundaryKind::nyquist:
      return "nyquist";
    case BoundaryKind::drift:
      return "drift";
    case BoundaryKind::no_stiffness:
      return "no_stiffness";
    case BoundaryKind::no_damping:
      break;
  }
  return "no_damping";
}

}  // namespace zwidth::report
