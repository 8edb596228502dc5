#include "results/region_json.hpp"

#include <optional>
#include <string>

#include "results/csv.hpp"
#include "results/stability_json.hpp"
#include "results/units.hpp"
#include "results/wall_filter_json.hpp"

namespace zwidth::results {

static WallRegion::Status status_of(const NobodysRegion& nobody) {
  if (!nobody.region.bounded) return WallRegion::Status::unbounded;
  return nobody.region.components.empty() ? WallRegion::Status::none_stable : WallRegion::Status::bounded;
}

static void to_json(Json& json, const BoundaryPoint& point) {
  json = {{"stiffness", point.stiffness},
          {"damping", point.damping},
          {"frequency_rad_s", point.frequency},
          {"limited_by", point.limited_by}};
}

static void to_json(Json& json, const AbsoluteStabilityPoint& point) {
  json = {{"stiffness", point.stiffness},
          {"damping", point.damping},
          {"frequency_rad_s", point.stiffness > 0.0 ? std::optional(point.frequency) : std::nullopt}};
}

static void to_json(Json& json, const BoundaryArc& arc) { json = {{"boundary", arc.kind}, {"points", arc.points}}; }

static void to_json(Json& json, const StableComponent& component) {
  json = {
      {"area", component.area}, {"reaches_zero_stiffness", component.from_zero}, {"outline", component.outline.arcs}};
}

static void to_json(Json& json, const AbsoluteStabilityRegion& region) {
  json = {{"stiffest", region.stiffest},
          {"most_damped", region.most_damped},
          {"area", region.area},
          {"limits", region.ranges}};
}

/// A point, and whose boundary it is on.
static void to_json(Json& json, const SharedPoint& shared) {
  to_json(json, shared.point);
  json["holder"] = shared.holder;
}

/// The walls of one holder, as the document has those with the file's user.
static void to_json(Json& json, const NobodysRegion& nobody) {
  const StableRegion& region = nobody.region;
  json = {{"status", status_of(nobody)},
          {"critical_stiffness", region.critical_stiffness},
          {"stiffest", region.stiffest},
          {"most_damped", region.most_damped},
          {"area", region.bounded ? std::optional(region.area) : std::nullopt},
          {"components", region.components}};
}

static void to_json(Json& json, const SharedWalls& shared) {
  json = {{"critical_stiffness", shared.critical_stiffness},
          {"stiffest", shared.stiffest},
          {"most_damped", shared.most_damped},
          {"area", shared.area}};
}

static void to_json(Json& json, const ComparedApproximation& compared) {
  const RegionApproximation& formula = compared.formula;
  const ApproximationError& error = compared.error;
  const FormulaFacts facts = facts_of(formula.formula);
  json = {{"formula", formula.formula},
          {"source", facts.source},
          {"valid_for", facts.valid_for},
          {"not_met", words_of(formula.not_met)},
          {"about", formula.any_user ? "any_user" : "device"},
          {"stiffness_at_zero_damping", formula.at_zero_damping},
          {"slope", formula.slope},
          {"largest_damping", formula.largest_damping},
          {"exact_stiffness_at_zero_damping", error.at_zero_damping},
          {"ratio_at_zero_damping", error.ratio},
          {"off_db", decibels(error.ratio)},
          {"unsafe", error.unsafe},
          {"unsafe_share", error.unsafe_share},
          {"missed_share", error.missed_share}};
}

namespace {

/// Of any wall (K, B) of the region: K per_stiffness + B per_damping.
Json force_per_count_json(const WallRegion& walls, const Wall& wall) {
  if (!walls.force_per_count) return nullptr;
  return {{"per_stiffness", walls.force_per_count->per_stiffness},
          {"per_damping", walls.force_per_count->per_damping},
          {"exact", wall.filters.empty()}};
}

}  // namespace

Json region_json(const Device& device, const WallRegion& walls) {
  const DeviceParameters& parameters = device.parameters();
  const StableRegion& region = walls.region;
  const bool refused = walls.status == WallRegion::Status::refused;
  Json json = document("zwidth.region/1");
  json["device"] = parameters.name;
  json["units"] = wall_units(parameters.motion);
  json["limits"] = walls.limits;
  json["velocity_filter_hz"] = parameters.wall.velocity_filter_hz;
  json["wall_filters"] = wall_filters_json(parameters.wall, parameters.loop.sampling_period);
  json["status"] = walls.status;
  json["critical_stiffness"] = refused ? std::nullopt : std::optional(region.critical_stiffness);
  json["stiffest"] = region.stiffest;
  json["most_damped"] = region.most_damped;
  json["area"] = region.bounded && !refused ? std::optional(region.area) : std::nullopt;
  json["components"] = region.components;
  json["nobody"] = walls.nobody;
  json["nobody_and_user"] = walls.shared;
  json["any_user"] = walls.any_user;
  json["approximations"] = walls.approximations;
  json["force_per_count"] = force_per_count_json(walls, parameters.wall);
  add_findings(json, walls);
  return json;
}

std::string region_csv(const WallRegion& walls) {
  Csv csv({"component", "boundary", "stiffness", "damping", "frequency_rad_s", "mode", "trust", "holder"});
  const auto add = [&](const StableRegion& region, Holder holder) {
    for (std::size_t i = 0; i < region.components.size(); ++i) {
      for (const BoundaryArc& arc : region.components[i].outline.arcs) {
        for (const BoundaryPoint& point : arc.points) {
          const std::string mode = point.limited_by ? std::to_string(point.limited_by->mode) : "";
          csv.row(i + 1, name_of(arc.kind), point.stiffness, point.damping, point.frequency, mode, walls.trust,
                  name_of(holder));
        }
      }
    }
  };
  add(walls.region, walls.nobody ? Holder::user : Holder::nobody);
  if (walls.nobody) add(walls.nobody->region, Holder::nobody);
  return csv.text();
}

std::string region_raster_csv(const WallRaster& raster, const Trust& trust) {
  Csv csv({"stiffness", "damping", "stable", "trust"});
  const std::size_t columns = raster.stiffnesses.size();
  for (std::size_t i = 0; i < raster.stable.size(); ++i) {
    csv.row(raster.stiffnesses[i % columns], raster.dampings[i / columns], raster.stable[i], trust);
  }
  return csv.text();
}

}  // namespace zwidth::results
