#include "results/design_json.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "results/csv.hpp"
#include "results/stability_json.hpp"
#include "results/units.hpp"
#include "zwidth/model/mechanism_key.hpp"

namespace zwidth::results {

namespace {

Json stiffness_units(Motion motion) { return {{"stiffness", units_of(motion).stiffness}}; }

std::optional<double> stiffness_of(const std::optional<AbsoluteStabilityLimit>& limit) {
  return limit ? std::optional(limit->stiffness) : std::nullopt;
}

std::optional<double> frequency_of(const std::optional<Crossover>& limit) {
  return limit ? std::optional(limit->frequency) : std::nullopt;
}

std::optional<Oscillator> oscillator_of(const std::optional<Crossover>& limit) {
  return limit ? std::optional(limit->limited_by) : std::nullopt;
}

Json sensitivity_json(const std::string& key, double value, const Device& device, const Design& design) {
  const auto find = [&key](const std::vector<Sensitivity>& all) -> std::optional<Sensitivity> {
    const auto found = std::ranges::find(all, key, &Sensitivity::key);
    return found != all.end() ? std::optional(*found) : std::nullopt;
  };
  const auto slope = [](const std::optional<Sensitivity>& each) { return each ? Json(each->slope) : Json(nullptr); };
  const auto relative = [](const std::optional<Sensitivity>& each) {
    return each ? Json(each->relative) : Json(nullptr);
  };
  const std::optional<Sensitivity> own = find(design.sensitivities);
  const std::optional<Sensitivity> any_user = find(design.absolute_stability_sensitivities);
  return {{"parameter", key},
          {"value", value},
          {"unit", parameter_unit(key, motion_of_key(device.parameters(), key))},
          {"slope", slope(own)},
          {"relative", relative(own)},
          {"any_user_slope", slope(any_user)},
          {"any_user_relative", relative(any_user)}};
}

/// What the two states of a notch's device are compared by.
Json state_json(const std::optional<NotchState>& state) {
  if (!state) return nullptr;
  const CriticalStiffness& critical = state->analysis.critical;
  return {{"critical_stiffness", critical.stiffness},
          {"critical_frequency_rad_s", frequency_of(critical.limit)},
          {"limited_by", oscillator_of(critical.limit)},
          {"any_user_stiffness", stiffness_of(state->analysis.any_user)},
          {"limits", state->analysis.limits},
          {"wall", state->analysis.wall}};
}

Json critical_json(const CriticalStiffness& critical) {
  return {{"status", critical.status},
          {"critical_stiffness", critical.stiffness},
          {"frequency_rad_s", frequency_of(critical.limit)},
          {"limited_by", oscillator_of(critical.limit)}};
}

/// The value of the key with the greatest K; null where that is not known.
Json best_json(const DesignComparison& comparison, const std::optional<BestDesigns>& best) {
  return best && best->is_best_of_all ? Json(comparison.designs[best->best].value) : Json(nullptr);
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
          {"limited_by_beyond", oscillator_of(each.beyond)}};
}

void to_json(Json& json, const SweepPoint& point) {
  json = {{"status", point.status},
          {"critical_stiffness", point.stiffness},
          {"frequency_rad_s", frequency_of(point.limit)},
          {"limited_by", oscillator_of(point.limit)},
          {"any_user_stiffness", stiffness_of(point.any_user)},
          {"trust", point.trust}};
}

void to_json(Json& json, const NotchAtModalShift& each) {
  json = {{"drift", each.modal_shift}, {"without", each.without}, {"with", each.with}};
}

void to_json(Json& json, const ComparedDesign& each) {
  json = {{"value", each.value},
          {"free", critical_json(each.free)},
          {"any_user_stiffness", stiffness_of(each.any_user)},
          {"with_operator", each.held ? critical_json(*each.held) : Json(nullptr)},
          {"limits", each.limits}};
}

Json design_json(const Device& device, const Design& design) {
  Json json = document("zwidth.design/1");
  json["device"] = device.name();
  json["units"] = stiffness_units(device.parameters().motion);
  json["limits"] = design.analysis.limits;
  json["trust"] = design.trust;
  add_critical(json, design.analysis.critical);
  json["any_user_stiffness"] = stiffness_of(design.analysis.any_user);
  json["sensitivities"] = Json::array();
  for (const Sensitivity& each : design.sensitivities) {
    json["sensitivities"].push_back(sensitivity_json(each.key, each.value, device, design));
  }
  for (const Sensitivity& each : design.absolute_stability_sensitivities) {
    if (find_sensitivity(design.sensitivities, each.key) != nullptr) continue;
    json["sensitivities"].push_back(sensitivity_json(each.key, each.value, device, design));
  }
  json["branch_switches"] = design.branch_switches;
  json["remarks"] = design.remarks;
  json["findings"] = findings_json(design.trust, design.remarks);
  return json;
}

Json sweep_json(const Device& swept, const ParameterSweep& sweep) {
  const DeviceParameters& device = swept.parameters();
  Json json = document("zwidth.design_sweep/1");
  json["device"] = device.name;
  json["units"] = stiffness_units(device.motion);
  json["trust"] = sweep.trust;
  json["findings"] = findings_json(sweep.trust);
  json["axes"] = Json::array();
  for (std::size_t i = 0; i < sweep.axes.size(); ++i) {
    const std::string& key = sweep.axes[i].key;
    json["axes"].push_back(
        {{"parameter", key}, {"unit", parameter_unit(key, motion_of_key(device, key))}, {"values", sweep.values[i]}});
  }
  json["points"] = sweep.points;
  return json;
}

std::string sweep_csv(const ParameterSweep& sweep) {
  Csv csv;
  for (const SweepAxis& axis : sweep.axes) csv.cell(axis.key);
  for (const char* name : {"critical_stiffness", "frequency_rad_s", "mode"}) csv.cell(name);
  if (sweep.has_any_user) csv.cell("any_user_stiffness");
  csv.cell("trust");
  csv.end_row();
  const std::size_t columns = sweep.axes.size() == 2 ? sweep.values[1].size() : 1;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const SweepPoint& point = sweep.points[i];
    csv.cell(sweep.values[0][i / columns]);
    if (sweep.axes.size() == 2) csv.cell(sweep.values[1][i % columns]);
    csv.cell(point.stiffness);
    csv.cell(frequency_of(point.limit));
    csv.cell(point.limit ? std::optional(point.limit->limited_by.mode) : std::nullopt);
    if (sweep.has_any_user) csv.cell(point.any_user ? std::optional(point.any_user->stiffness) : std::nullopt);
    csv.cell(point.trust);
    csv.end_row();
  }
  return csv.text();
}

Json comparison_json(const DesignComparison& comparison) {
  const DeviceParameters& device = comparison.designs.front().device.parameters();
  const bool held = comparison.designs.front().held.has_value();
  const User& user = comparison.user;
  Json json = document("zwidth.design_comparison/1");
  json["device"] = device.name;
  json["units"] = stiffness_units(device.motion);
  json["parameter"] = comparison.key;
  json["operator"] = nullptr;
  if (held) json["operator"] = {{"mass", user.mass}, {"damping", user.damping}, {"stiffness", user.stiffness}};
  json["designs"] = comparison.designs;
  json["best"] = {{"free", best_json(comparison, comparison.best_free)},
                  {"any_user", best_json(comparison, comparison.best_any_user)},
                  {"with_operator", best_json(comparison, comparison.best_held)}};
  json["trust"] = comparison.trust;
  json["findings"] = findings_json(comparison.trust);
  return json;
}

Json notch_json(const Device& device, const NotchOptions& options, const NotchDesign& design) {
  const DeviceParameters& parameters = device.parameters();
  Json json = document("zwidth.notch/1");
  json["device"] = parameters.name;
  json["units"] = wall_units(parameters.motion);
  json["goal"] = options.goal;
  json["drift"] = options.modal_frequency_uncertainty;
  json["gain_margin"] = options.gain_margin;
  json["phase_margin_rad"] = options.phase_margin;
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
  json["over_drift"] = design.over_modal_shift;
  json["without"] = state_json(design.state_without);
  json["with"] = state_json(design.state_with);
  add_findings(json, design);
  return json;
}

}  // namespace zwidth::results
