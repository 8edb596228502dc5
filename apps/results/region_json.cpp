#include "results/region_json.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "results/csv.hpp"
#include "results/stability_json.hpp"
#include "results/units.hpp"
#include "results/wall_filter_json.hpp"

namespace zwidth::results {

static void to_json(Json& json, const BoundaryPoint& point) {
  json = {{"stiffness", point.stiffness},
          {"damping", point.damping},
          {"frequency_rad_s", point.frequency},
          {"limited_by", point.limited_by}};
}

static void to_json(Json& json, const AnyUserPoint& point) {
  json = {{"stiffness", point.stiffness},
          {"damping", point.damping},
          {"frequency_rad_s", point.stiffness > 0.0 ? std::optional(point.frequency) : std::nullopt}};
}

static void to_json(Json& json, const BoundaryArc& arc) { json = {{"boundary", arc.kind}, {"points", arc.points}}; }

static void to_json(Json& json, const StableComponent& component) {
  json = {
      {"area", component.area}, {"reaches_zero_stiffness", component.from_zero}, {"outline", component.outline.arcs}};
}

static void to_json(Json& json, const AnyUserRegion& region) {
  json = {{"stiffest", region.stiffest},
          {"most_damped", region.most_damped},
          {"area", region.area},
          {"limits", region.ranges}};
}

static void to_json(Json& json, const ComparedApproximation& compared) {
  const RegionApproximation& formula = compared.formula;
  const ApproximationError& error = compared.error;
  const FormulaFacts facts = facts_of(formula.formula);
  const bool at_zero_alone = formula.largest_damping == 0.0;
  json = {{"formula", formula.formula},
          {"source", facts.source},
          {"valid_for", facts.valid_for},
          {"not_met", formula.not_met},
          {"about", formula.any_user ? "any_user" : "device"},
          {"stiffness_at_zero_damping", formula.at_zero_damping},
          {"slope", formula.slope},
          {"largest_damping", formula.largest_damping},
          {"exact_stiffness_at_zero_damping", error.at_zero_damping},
          {"ratio_at_zero_damping", error.ratio},
          {"off_db", decibels(error.ratio)},
          {"unsafe_share", at_zero_alone ? std::nullopt : std::optional(error.unsafe_share)},
          {"missed_share", at_zero_alone ? std::nullopt : std::optional(error.missed_share)}};
}

namespace {

/// Of any wall (K, B) of the region: K per_stiffness + B per_damping.
Json force_per_count_json(const WallRegion& walls, const Wall& wall) {
  if (!walls.force_per_count) return nullptr;
  return {{"per_stiffness", walls.force_per_count->per_stiffness},
          {"per_damping", walls.force_per_count->per_damping},
          {"exact", wall.filters.empty()}};
}

const char* status_of(const WallRegion& region) {
  if (region.trust.refused()) return "refused";
  if (!region.region.bounded) return "unbounded";
  return region.region.components.empty() ? "none_stable" : "bounded";
}

std::vector<double> middles(double largest, std::size_t count) {
  constexpr double beyond = 1.1;
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = beyond * largest * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
  }
  return values;
}

}  // namespace

Json region_json(const Device& device, const WallRegion& walls) {
  const DeviceParameters& parameters = device.parameters();
  const StableRegion& region = walls.region;
  const bool refused = walls.trust.refused();
  Json json = document("zwidth.region/1");
  json["device"] = parameters.name;
  json["units"] = wall_units(parameters.motion);
  json["velocity_filter_hz"] = parameters.wall.velocity_filter_hz;
  json["wall_filters"] = wall_filters_json(parameters.wall, parameters.loop.sampling_period);
  json["status"] = status_of(walls);
  json["critical_stiffness"] = refused ? std::nullopt : std::optional(region.critical_stiffness);
  json["stiffest"] = region.stiffest;
  json["most_damped"] = region.most_damped;
  json["area"] = region.bounded && !refused ? std::optional(region.area) : std::nullopt;
  json["components"] = region.components;
  json["any_user"] = walls.any_user;
  json["approximations"] = walls.approximations;
  json["force_per_count"] = force_per_count_json(walls, parameters.wall);
  json["trust"] = walls.trust;
  json["remarks"] = walls.remarks;
  return json;
}

std::string region_csv(const StableRegion& region) {
  Csv csv({"component", "boundary", "stiffness", "damping", "frequency_rad_s", "mode"});
  for (std::size_t i = 0; i < region.components.size(); ++i) {
    for (const BoundaryArc& arc : region.components[i].outline.arcs) {
      for (const BoundaryPoint& point : arc.points) {
        const std::string mode = point.limited_by ? std::to_string(point.limited_by->mode) : "";
        csv.row(i + 1, name_of(arc.kind), point.stiffness, point.damping, point.frequency, mode);
      }
    }
  }
  return csv.text();
}

std::string region_raster_csv(const WallRegion& walls, std::size_t count) {
  Csv csv({"stiffness", "damping", "stable"});
  if (!walls.walls || !walls.region.stiffest) return csv.text();
  const std::vector<double> stiffnesses = middles(walls.region.stiffest->stiffness, count);
  const std::vector<double> dampings = middles(walls.region.most_damped->damping, count);
  const std::vector<std::uint8_t> stable = stable_on_grid(*walls.walls, stiffnesses, dampings);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) csv.row(stiffnesses[j], dampings[i], stable[i * count + j]);
  }
  return csv.text();
}

}  // namespace zwidth::results
