#include "results/analysis_json.hpp"

#include <cmath>
#include <optional>

#include "results/force_per_count_json.hpp"
#include "results/stability_json.hpp"
#include "results/units.hpp"
#include "results/wall_filter_json.hpp"

namespace zwidth::results {
namespace {

Json any_user_json(const Analysis& analysis) {
  if (!analysis.any_user) return nullptr;
  const AnyUserLimit& limit = *analysis.any_user;
  const bool has_frequency = limit.stiffness > 0.0 && std::isfinite(limit.stiffness);
  return {{"critical_stiffness", limit.stiffness},
          {"frequency_rad_s", has_frequency ? std::optional(limit.frequency) : std::nullopt},
          {"truncation", limit.truncation},
          {"critical_stiffness_interval", limit.interval},
          {"worst_user", analysis.worst_user}};
}

/// The wall's margins are those with the file's user; it is stable where it is with nobody too.
Json wall_json(const Analysis& analysis) {
  Json json = analysis.wall;
  if (!analysis.wall) return json;
  json["stable"] = stability_of(*analysis.wall_stable_for) != WallStability::unstable;
  json["stable_for"] = analysis.wall_stable_for;
  json["disk_margin"] = analysis.disk_margin;
  return json;
}

Json range_json(const ValueRange& range) { return Json::array({range.least, range.greatest}); }

Json user_family_json(const Analysis& analysis) {
  if (!analysis.user_family) return nullptr;
  const UserFamilyAnswer& answer = *analysis.user_family;
  const Operator& user = answer.worst.user;
  return {{"mass", range_json(answer.family.mass)},
          {"damping", range_json(answer.family.damping)},
          {"stiffness", range_json(answer.family.stiffness)},
          {"worst_user", {{"mass", user.mass}, {"damping", user.damping}, {"stiffness", user.stiffness}}},
          {"critical_stiffness", answer.worst.critical_stiffness},
          {"free_critical_stiffness", answer.free.stiffness}};
}

Json quantisation_json(const std::optional<QuantisationPassivity>& bound) {
  if (!bound) return nullptr;
  return {{"stiffness", bound->stiffness},
          {"friction_stiffness", bound->friction_stiffness},
          {"damping_stiffness", bound->damping_stiffness},
          {"not_met", bound->not_met},
          {"source", "Abbott & Okamura 2005"}};
}

Json virtual_damper_json(const Wall& wall) {
  if (!(wall.damping > 0.0)) return nullptr;
  return {{"damping", wall.damping}, {"velocity_filter_hz", wall.velocity_filter_hz}};
}

std::optional<std::string> uncertainty_warning(const DeviceParameters& device) {
  if (!device.uncertainty || device.uncertainty->warning.empty()) return std::nullopt;
  return device.uncertainty->warning;
}

}  // namespace

Json analysis_json(const Device& analysed, const Analysis& analysis) {
  const DeviceParameters& device = analysed.parameters();

  Json json = document("zwidth.analysis/1");
  json["device"] = device.name;
  json["units"] = wall_units(device.motion);
  add_critical(json, analysis.critical);
  json["limits"] = analysis.limits;
  json["stable_intervals"] = analysis.critical.stable_intervals;
  json["crossovers"] = analysis.critical.crossovers;
  json["modes"] = analysis.modes;
  json["suspended_rigid_body"] = analysis.suspended_rigid_body;
  json["rigid_approximation"] = analysis.rigid;
  json["q_criterion"] = analysis.q_criterion;
  json["any_user"] = any_user_json(analysis);
  json["user_family"] = user_family_json(analysis);
  json["virtual_damper"] = virtual_damper_json(device.wall);
  json["wall_filters"] = wall_filters_json(device.wall, device.loop.sampling_period);
  json["wall"] = wall_json(analysis);
  json["force_per_count"] = analysis.force_per_count;
  json["quantisation_passivity"] = quantisation_json(analysis.quantisation);
  json["critical_stiffness_interval"] = analysis.interval;
  json["other_mechanism_share"] = analysis.interval ? Json(analysis.interval->other_mechanism) : Json(nullptr);
  json["uncertainty_warning"] = uncertainty_warning(device);
  json["assumed"] = device.uncertainty ? device.uncertainty->assumed : std::vector<std::string>{};
  json["trust"] = analysis.trust;
  json["remarks"] = analysis.remarks;
  return json;
}

}  // namespace zwidth::results
