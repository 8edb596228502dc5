#include "results/design_json.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "results/csv.hpp"
#include "results/stability_json.hpp"
#include "results/units.hpp"

namespace zwidth::results {

NLOHMANN_JSON_SERIALIZE_ENUM(StiffnessGoal, {{StiffnessGoal::critical_stiffness, "critical_stiffness"},
                                             {StiffnessGoal::any_user_limit, "any_user_limit"}})

namespace {

Json stiffness_units(Motion motion) { return {{"stiffness", units_of(motion).stiffness}}; }

std::optional<double> stiffness_of(const std::optional<AnyUserLimit>& limit) {
  return limit ? std::optional(limit->stiffness) : std::nullopt;
}

std::optional<double> frequency_of(const std::optional<Crossover>& limit) {
  return limit ? std::optional(limit->frequency) : std::nullopt;
}

std::optional<Mechanism> mechanism_of(const std::optional<Crossover>& limit) {
  return limit ? std::optional(limit->limited_by) : std::nullopt;
}

Json sensitivity_json(const std::string& key, double value, const report::DesignedDevice& designed) {
  const auto find = [&key](const std::vector<Sensitivity>& all) -> std::optional<Sensitivity> {
    const auto found = std::ranges::find(all, key, &Sensitivity::key);
    return found != all.end() ? std::optional(*found) : std::nullopt;
  };
  const auto slope = [](const std::optional<Sensitivity>& each) { return each ? Json(each->slope) : Json(nullptr); };
  const auto relative = [](const std::optional<Sensitivity>& each) {
    return each ? Json(each->relative) : Json(nullptr);
  };
  const std::optional<Sensitivity> own = find(designed.sensitivities);
  const std::optional<Sensitivity> any_user = find(designed.any_user);
  return {{"parameter", key},
          {"value", value},
          {"unit", parameter_unit(key, designed.analysed.device.parameters().motion)},
          {"slope", slope(own)},
          {"relative", relative(own)},
          {"any_user_slope", slope(any_user)},
          {"any_user_relative", relative(any_user)}};
}

/// What the two states of a notch's device are compared by.
Json state_json(const report::AnalysedDevice& device) {
  const CriticalStiffness& critical = device.analysis.critical;
  return {{"critical_stiffness", critical.stiffness},
          {"critical_frequency_rad_s", frequency_of(critical.limit)},
          {"limited_by", mechanism_of(critical.limit)},
          {"any_user_stiffness", stiffness_of(device.analysis.any_user)},
          {"wall", device.analysis.wall}};
}

Json critical_json(const CriticalStiffness& critical) {
  return {{"status", critical.status},
          {"critical_stiffness", critical.stiffness},
          {"frequency_rad_s", frequency_of(critical.limit)},
          {"limited_by", mechanism_of(critical.limit)}};
}

/// The value of the key with the greatest K; null where a design has none, or where no wall is stable with any.
Json best_json(const report::DesignComparison& comparison,
               std::optional<double> (*stiffness)(const report::ComparedDesign&)) {
  Json best = nullptr;
  double greatest = 0.0;
  for (const report::ComparedDesign& each : comparison.designs) {
    const std::optional<double> value = stiffness(each);
    if (!value) return nullptr;
    if (*value > greatest) {
      greatest = *value;
      best = each.value;
    }
  }
  return best;
}

}  // namespace

void to_json(Json& json, const BranchSwitch& each) {
  json = {{"parameter", each.key},
          {"value", each.value},
          {"critical_stiffness", each.stiffness},
          {"critical_stiffness_beyond", each.stiffness_beyond},
          {"frequency_rad_s", each.before.frequency},
          {"limited_by", each.before.limited_by},
          {"frequency_beyond_rad_s", frequency_of(each.beyond)},
          {"limited_by_beyond", mechanism_of(each.beyond)}};
}

void to_json(Json& json, const SweepPoint& point) {
  json = {{"status", point.status},
          {"critical_stiffness", point.stiffness},
          {"frequency_rad_s", frequency_of(point.limit)},
          {"limited_by", mechanism_of(point.limit)},
          {"any_user_stiffness", stiffness_of(point.any_user)}};
}

void to_json(Json& json, const NotchAtDrift& each) {
  json = {{"drift", each.drift}, {"without", each.without}, {"with", each.with}};
}

void to_json(Json& json, const report::ComparedDesign& each) {
  json = {{"value", each.value},
          {"free", critical_json(each.free)},
          {"any_user_stiffness", stiffness_of(each.any_user)},
          {"with_operator", each.held ? critical_json(*each.held) : Json(nullptr)}};
}

Json design_json(const report::DesignedDevice& designed) {
  const DeviceParameters& device = designed.analysed.device.parameters();
  const CriticalStiffness& critical = designed.analysed.analysis.critical;
  Json json = document("zwidth.design/1");
  json["device"] = device.name;
  json["units"] = stiffness_units(device.motion);
  add_critical(json, critical);
  json["any_user_stiffness"] = stiffness_of(designed.analysed.analysis.any_user);
  json["sensitivities"] = Json::array();
  for (const Sensitivity& each : designed.sensitivities) {
    json["sensitivities"].push_back(sensitivity_json(each.key, each.value, designed));
  }
  for (const Sensitivity& each : designed.any_user) {
    if (std::ranges::find(designed.sensitivities, each.key, &Sensitivity::key) != designed.sensitivities.end())
      continue;
    json["sensitivities"].push_back(sensitivity_json(each.key, each.value, designed));
  }
  json["branch_switches"] = designed.branch_switches;
  return json;
}

Json sweep_json(const report::DesignSweep& design) {
  const DeviceParameters& device = design.device.parameters();
  Json json = document("zwidth.design_sweep/1");
  json["device"] = device.name;
  json["units"] = stiffness_units(device.motion);
  json["axes"] = Json::array();
  for (std::size_t i = 0; i < design.sweep.axes.size(); ++i) {
    const std::string& key = design.sweep.axes[i].key;
    json["axes"].push_back(
        {{"parameter", key}, {"unit", parameter_unit(key, device.motion)}, {"values", design.sweep.values[i]}});
  }
  json["points"] = design.sweep.points;
  return json;
}

std::string sweep_csv(const report::DesignSweep& design) {
  const ParameterSweep& sweep = design.sweep;
  const bool any_user = sweep.points.front().any_user.has_value();
  Csv csv;
  for (const SweepAxis& axis : sweep.axes) csv.cell(axis.key);
  for (const char* name : {"critical_stiffness", "frequency_rad_s", "mode"}) csv.cell(name);
  if (any_user) csv.cell("any_user_stiffness");
  csv.end_row();
  const std::size_t columns = sweep.axes.size() == 2 ? sweep.values[1].size() : 1;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const SweepPoint& point = sweep.points[i];
    csv.cell(sweep.values[0][i / columns]);
    if (sweep.axes.size() == 2) csv.cell(sweep.values[1][i % columns]);
    csv.cell(point.stiffness);
    csv.cell(frequency_of(point.limit));
    csv.cell(point.limit ? std::optional(point.limit->limited_by.mode) : std::nullopt);
    if (any_user) csv.cell(point.any_user->stiffness);
    csv.end_row();
  }
  return csv.text();
}

Json comparison_json(const report::DesignComparison& comparison) {
  const DeviceParameters& device = comparison.designs.front().device.parameters();
  const bool held = comparison.designs.front().held.has_value();
  const Operator& user = comparison.user;
  using report::ComparedDesign;
  Json json = document("zwidth.design_comparison/1");
  json["device"] = device.name;
  json["units"] = stiffness_units(device.motion);
  json["parameter"] = comparison.key;
  json["operator"] = nullptr;
  if (held) json["operator"] = {{"mass", user.mass}, {"damping", user.damping}, {"stiffness", user.stiffness}};
  json["designs"] = comparison.designs;
  json["best"] = {
      {"free",
       best_json(comparison, [](const ComparedDesign& each) -> std::optional<double> { return each.free.stiffness; })},
      {"any_user", best_json(comparison, [](const ComparedDesign& each) { return stiffness_of(each.any_user); })},
      {"with_operator", best_json(comparison, [](const ComparedDesign& each) -> std::optional<double> {
         return each.held ? std::optional(each.held->stiffness) : std::nullopt;
       })}};
  return json;
}

Json notch_json(const report::DesignedNotch& notch) {
  const DeviceParameters& parameters = notch.without.device.parameters();
  const NotchDesign& design = notch.design;
  Json json = document("zwidth.notch/1");
  json["device"] = parameters.name;
  json["units"] = wall_units(parameters.motion);
  json["goal"] = notch.options.goal;
  json["drift"] = notch.options.drift;
  json["gain_margin"] = notch.options.gain_margin;
  json["phase_margin_rad"] = notch.options.phase_margin;
  json["notch"] = nullptr;
  if (design.notch) {
    json["notch"] = {{"type", "notch"},
                     {"frequency_hz", design.notch->frequency_hz},
                     {"damping_ratio", design.notch->damping_ratio},
                     {"depth", design.notch->depth}};
  }
  json["stiffness_without"] = design.without;
  json["stiffness_with"] = design.with;
  json["low_frequency_delay_s"] = design.low_frequency_delay;
  json["over_drift"] = design.over_drift;
  json["without"] = state_json(notch.without);
  json["with"] = notch.with ? state_json(*notch.with) : Json(nullptr);
  return json;
}

}  // namespace zwidth::results
