#include "report/designed_notch.hpp"
#include "report/text/quantity.hpp"
#include "results/json_value.hpp"

namespace zwidth::report {
namespace {

using Json = results::Json;

Json state_json(const AnalysedDevice& device) {
  const CriticalStiffness& critical = device.analysis.critical;
  Json state{{"critical_stiffness", number_or_null(critical.stiffness)},
             {"critical_frequency_rad_s", critical.limit ? Json(critical.limit->frequency) : Json(nullptr)},
             {"limited_by", critical.limit ? mechanism_json(critical.limit->limited_by) : Json(nullptr)},
             {"any_user_stiffness",
              device.analysis.any_user ? number_or_null(device.analysis.any_user->stiffness) : Json(nullptr)},
             {"wall", nullptr}};
  if (const auto& wall = device.analysis.wall) {
    const Json gain_db = wall->gain_margin ? Json(decibels(*wall->gain_margin)) : Json(nullptr);
    state["wall"] = {{"stiffness", wall->stiffness},
                     {"damping", wall->damping},
                     {"stable", wall->stable},
                     {"gain_margin_db", gain_db},
                     {"phase_margin_rad", number_or_null(wall->phase_margin)},
                     {"delay_margin_s", number_or_null(wall->delay_margin)}};
  }
  return state;
}

}  // namespace

Json notch_json(const DesignedNotch& notch) {
  const DeviceParameters& parameters = notch.without.device.parameters();
  const Units units = units_of(parameters.motion);
  const NotchDesign& design = notch.design;
  Json document;
  document["schema"] = "zwidth.notch/1";
  document["device"] = parameters.name;
  document["units"] = {{"stiffness", units.stiffness}, {"damping", units.damping}};
  document["goal"] = notch.options.goal == StiffnessGoal::any_user_limit ? "any_user_limit" : "critical_stiffness";
  document["drift"] = notch.options.drift;
  document["gain_margin"] = notch.options.gain_margin;
  document["phase_margin_rad"] = notch.options.phase_margin;
  document["notch"] = nullptr;
  if (design.notch) {
    document["notch"] = {{"type", "notch"},
                         {"frequency_hz", design.notch->frequency_hz},
                         {"damping_ratio", design.notch->damping_ratio},
                         {"depth", design.notch->depth}};
  }
  document["stiffness_without"] = number_or_null(design.without);
  document["stiffness_with"] = number_or_null(design.with);
  document["low_frequency_delay_s"] = design.low_frequency_delay;
  document["over_drift"] = Json::array();
  for (const NotchAtDrift& each : design.over_drift) {
    document["over_drift"].push_back(
        {{"drift", each.drift}, {"without", number_or_null(each.without)}, {"with", number_or_null(each.with)}});
  }
  document["without"] = state_json(notch.without);
  document["with"] = notch.with ? state_json(*notch.with) : Json(nullptr);
  return document;
}

}  // namespace zwidth::report
