#include "results/analysis_json.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "results/force_per_count_json.hpp"
#include "results/stability_json.hpp"
#include "results/units.hpp"
#include "results/wall_filter_json.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::results {
namespace {

Json absolute_stability_json(const Analysis& analysis) {
  if (!analysis.any_user) return nullptr;
  const AbsoluteStabilityLimit& limit = *analysis.any_user;
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
  json["spring_delay_margin_s"] = analysis.wall->spring_delay_margin;
  json["damper_delay_margin_s"] = analysis.wall->damper_delay_margin;
  json["stable"] = stability_of(*analysis.wall_stable_for) != WallStability::unstable;
  json["stable_for"] = analysis.wall_stable_for;
  json["disk_margin"] = analysis.disk_margin;
  return json;
}

Json range_json(const ValueRange& range) { return Json::array({range.least, range.greatest}); }

Json user_family_json(const Analysis& analysis) {
  if (!analysis.user_family) return nullptr;
  const UserFamilyAnswer& answer = *analysis.user_family;
  const User& user = answer.worst.user;
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
          {"not_met", words_of(bound->not_met)},
          {"source", "Abbott & Okamura 2005"}};
}

Json virtual_damper_json(const Wall& wall) {
  if (!(wall.damping > 0.0)) return nullptr;
  return {{"damping", wall.damping}, {"velocity_filter_hz", wall.velocity_filter_hz}};
}

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json with_damper_json(const WallSummary& walls) {
  if (!walls.with_damper) return nullptr;
  const StiffestDampedWall& wall = *walls.with_damper;
  return {{"stiffness", wall.stiffness},
          {"damping", wall.damping},
          {"velocity_filter_hz", wall.velocity_filter_hz},
          {"stable_for", wall.holder == Holder::any_user ? "any_user" : "nobody"},
          {"trust", wall.trust},
          {"findings", findings_json(wall.trust)}};
}

Json with_margins_json(const WallSummary& walls) {
  if (!walls.with_margins) return nullptr;
  const RecommendedWall& each = *walls.with_margins;
  Json notch = nullptr;
  if (each.notch) {
    notch = {{"frequency_hz", each.notch->frequency_hz},
             {"damping_ratio", each.notch->damping_ratio},
             {"depth", each.notch->depth}};
  }
  return {{"stiffness", each.wall.stiffness},
          {"damping", each.wall.damping},
          {"velocity_filter_hz", each.wall.velocity_filter_hz},
          {"notch", std::move(notch)},
          {"stable_for", each.absolute_stability_limit ? "any_user" : "nobody"},
          {"any_user_critical_stiffness", each.absolute_stability_limit},
          {"gain_margin_db", decibels(each.margins.gain_margin)},
          {"phase_margin_rad", each.margins.phase_margin}};
}

/// The walls of the first lines.
Json walls_json(const std::optional<WallSummary>& walls) {
  if (!walls) return nullptr;
  return {{"with_damper", with_damper_json(*walls)},
          {"why_no_damper", text_or_null(text(walls->why_no_damper))},
          {"with_margins", with_margins_json(*walls)},
          {"why_no_margins", text_or_null(text(walls->why_no_margins))}};
}

/// What a wall in every direction has instead of crossovers and a mode.
void add_point_wall(Json& json, const Analysis& analysis) {
  const PointWallAnswer& point = *analysis.point_wall;
  std::optional<double> frequency;
  Json direction = nullptr;
  if (analysis.critical.status == StiffnessStatus::finite) {
    frequency = point.frequency;
    direction = Json::array({point.direction.x(), point.direction.y(), point.direction.z()});
  }
  json["critical_frequency_rad_s"] = frequency;
  json["critical_frequency_hz"] = hertz(frequency);
  Json any_user = nullptr;
  if (point.any_user) any_user = {{"at_least", point.any_user->at_least}, {"at_most", point.any_user->at_most}};
  json["point_wall"] = {{"direction", std::move(direction)}, {"any_user", std::move(any_user)}};
}

/// Where the tip of a mechanism is, and the joints that bring it there.
Json mechanism_json(const MechanismFile& file) {
  const MechanismModel model(file);
  const MechanismAtPose at = model.at();
  Json list = Json::array();
  for (std::size_t i = 0; i < model.joints().size(); ++i) {
    const MechanismJoint& joint = model.joints()[i];
    if (!joint.is_of_pose) continue;
    list.push_back({{"name", joint.name},
                    {"unit", unit_of(Measure::position, joint.motion)},
                    {"position", at.joints(static_cast<Eigen::Index>(i))},
                    {"range", joint.range ? Json::array({joint.range->least, joint.range->greatest}) : Json()}});
  }
  const Eigen::Vector3d& tip = at.tip_position;
  return {{"tip", Json::array({tip.x(), tip.y(), tip.z()})}, {"joints", std::move(list)}};
}

std::optional<std::string> uncertainty_warning(const DeviceParameters& device) {
  if (!device.uncertainty || device.uncertainty->warning.empty()) return std::nullopt;
  return device.uncertainty->warning;
}

}  // namespace

Json analysis_json(const Device& analysed, const Analysis& analysis, const std::optional<WallSummary>& walls) {
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
  json["any_user"] = absolute_stability_json(analysis);
  json["user_family"] = user_family_json(analysis);
  json["virtual_damper"] = virtual_damper_json(device.wall);
  json["wall_filters"] = wall_filters_json(device.wall, device.loop.sampling_period);
  json["wall"] = wall_json(analysis);
  json["walls"] = walls_json(walls);
  json["force_per_count"] = analysis.force_per_count;
  json["quantisation_passivity"] = quantisation_json(analysis.quantisation);
  json["critical_stiffness_interval"] = analysis.interval;
  json["other_mechanism_share"] = analysis.interval ? Json(analysis.interval->other_mechanism) : Json(nullptr);
  json["uncertainty_warning"] = uncertainty_warning(device);
  json["assumed"] = device.uncertainty ? device.uncertainty->assumed : std::vector<std::string>{};
  if (analysis.point_wall) add_point_wall(json, analysis);
  if (device.mechanism) json["mechanism"] = mechanism_json(device.mechanism->mechanism);
  add_findings(json, analysis);
  return json;
}

void LimitTable::add(const Device& device, const Analysis& analysis) {
  const auto limit_of = [](const std::optional<HolderLimit>& holder) {
    return holder ? std::optional(holder->critical_stiffness) : std::nullopt;
  };
  const HoldingLimits& limits = analysis.limits;
  const CriticalStiffness& critical = analysis.critical;
  const bool is_refused = analysis.trust.refused();
  csv_.row(device.name(), critical.stiffness, name_of(is_refused ? StiffnessStatus::refused : critical.status),
           limits.nobody.critical_stiffness, limit_of(limits.user), limit_of(limits.any_user),
           critical.limit ? std::optional(hertz(critical.limit->frequency)) : std::nullopt,
           units_of(device.parameters().motion).stiffness, analysis.trust);
}

}  // namespace zwidth::results
