#include "results/region_json.hpp"

#include "report/text/quantity.hpp"
#include "results/json_value.hpp"
#include "results/wall_filter_json.hpp"

namespace zwidth::report {
namespace {

using Json = results::Json;

Json to_json(const BoundaryArc& arc);
Json to_json(const BoundaryRing& ring);
Json to_json(const StableComponent& component);
Json to_json(const AnyUserRegion& region);

Json to_json(const BoundaryPoint& point) {
  return {{"stiffness", point.stiffness},
          {"damping", point.damping},
          {"frequency_rad_s", number_or_null(point.frequency)},
          {"limited_by", point.limited_by ? mechanism_json(*point.limited_by) : Json(nullptr)}};
}

Json to_json(const AnyUserPoint& point) {
  return {{"stiffness", point.stiffness},
          {"damping", point.damping},
          {"frequency_rad_s", point.stiffness > 0.0 ? Json(point.frequency) : Json(nullptr)}};
}

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? to_json(*value) : Json(nullptr);
}

template <typename T>
Json array_of(const std::vector<T>& values) {
  Json array = Json::array();
  for (const T& value : values) array.push_back(to_json(value));
  return array;
}

Json to_json(const BoundaryArc& arc) {
  return {{"boundary", boundary_key(arc.kind)}, {"points", array_of(arc.points)}};
}

Json to_json(const BoundaryRing& ring) { return array_of(ring.arcs); }

Json to_json(const StableComponent& component) {
  return {{"area", component.area},
          {"reaches_zero_stiffness", component.from_zero},
          {"outline", to_json(component.outline)}};
}

Json to_json(const AnyUserRegion& region) {
  Json polygons = Json::array();
  for (const auto& range : region.ranges) polygons.push_back(array_of(range));
  return {{"stiffest", or_null(region.stiffest)},
          {"most_damped", or_null(region.most_damped)},
          {"area", region.area},
          {"limits", std::move(polygons)}};
}

Json to_json(const ComparedApproximation& compared, const Device& device) {
  const RegionApproximation& formula = compared.formula;
  const ApproximationError& error = compared.error;
  Json off = error.ratio && *error.ratio > 0.0 ? Json(decibels(*error.ratio)) : Json(nullptr);
  const bool at_zero_alone = formula.largest_damping == 0.0;
  return {{"formula", formula_key(formula.formula)},
          {"source", formula_source(formula.formula)},
          {"valid_for", formula_validity(formula.formula)},
          {"not_met", unmet_assumptions(formula.formula, device)},
          {"about", formula.any_user ? "any_user" : "device"},
          {"stiffness_at_zero_damping", formula.at_zero_damping},
          {"slope", formula.slope},
          {"largest_damping", number_or_null(formula.largest_damping)},
          {"exact_stiffness_at_zero_damping", number_or_null(error.at_zero_damping)},
          {"ratio_at_zero_damping", number_or_null(error.ratio)},
          {"off_db", std::move(off)},
          {"unsafe_share", at_zero_alone ? Json(nullptr) : Json(error.unsafe_share)},
          {"missed_share", at_zero_alone ? Json(nullptr) : Json(error.missed_share)}};
}

const char* status_of(const StableRegion& region) {
  if (!region.bounded) return "unbounded";
  return region.components.empty() ? "none_stable" : "bounded";
}

}  // namespace

results::Json region_json(const DeviceRegion& device) {
  const DeviceParameters& parameters = device.analysed.device.parameters();
  const Units units = units_of(parameters.motion);
  const StableRegion& region = device.region;
  Json document;
  document["schema"] = "zwidth.region/1";
  document["device"] = parameters.name;
  document["units"] = {{"stiffness", units.stiffness}, {"damping", units.damping}};
  document["velocity_filter_hz"] = device.walls.velocity_filter_hz();
  document["wall_filters"] = results::wall_filters_json(parameters.wall, parameters.loop.sampling_period);
  document["status"] = status_of(region);
  document["critical_stiffness"] = number_or_null(region.critical_stiffness);
  document["stiffest"] = or_null(region.stiffest);
  document["most_damped"] = or_null(region.most_damped);
  document["area"] = region.bounded ? Json(region.area) : Json(nullptr);
  document["components"] = array_of(region.components);
  document["any_user"] = or_null(device.any_user);
  document["approximations"] = Json::array();
  for (const ComparedApproximation& each : device.approximations) {
    document["approximations"].push_back(to_json(each, device.analysed.device));
  }
  return document;
}

}  // namespace zwidth::report
