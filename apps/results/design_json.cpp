#include "results/design_json.hpp"

#include "report/text/quantity.hpp"
#include "results/json_value.hpp"

namespace zwidth::report {
namespace {

using Json = results::Json;

Json slope_or_null(const Sensitivity* sensitivity) {
  return sensitivity != nullptr ? number_or_null(sensitivity->slope) : Json(nullptr);
}

Json relative_or_null(const Sensitivity* sensitivity) {
  return sensitivity != nullptr ? number_or_null(sensitivity->relative) : Json(nullptr);
}

Json to_json(const std::string& key, double value, const DesignedDevice& designed) {
  const Sensitivity* own = find_sensitivity(designed.sensitivities, key);
  const Sensitivity* any_user = find_sensitivity(designed.any_user, key);
  return {{"parameter", key},
          {"value", value},
          {"unit", parameter_unit(key, designed.analysed.device.parameters().motion)},
          {"slope", slope_or_null(own)},
          {"relative", relative_or_null(own)},
          {"any_user_slope", slope_or_null(any_user)},
          {"any_user_relative", relative_or_null(any_user)}};
}

Json to_json(const BranchSwitch& each) {
  return {{"parameter", each.key},
          {"value", each.value},
          {"critical_stiffness", each.stiffness},
          {"critical_stiffness_beyond", number_or_null(each.stiffness_beyond)},
          {"frequency_rad_s", each.before.frequency},
          {"limited_by", mechanism_json(each.before.limited_by)},
          {"frequency_beyond_rad_s", each.beyond ? Json(each.beyond->frequency) : Json(nullptr)},
          {"limited_by_beyond", each.beyond ? mechanism_json(each.beyond->limited_by) : Json(nullptr)}};
}

}  // namespace

results::Json design_json(const DesignedDevice& designed) {
  const DeviceParameters& device = designed.analysed.device.parameters();
  const CriticalStiffness& critical = designed.analysed.analysis.critical;
  const auto& any_user = designed.analysed.analysis.any_user;
  Json document;
  document["schema"] = "zwidth.design/1";
  document["device"] = device.name;
  document["units"] = {{"stiffness", units_of(device.motion).stiffness}};
  document["status"] = status_name(critical.status);
  document["critical_stiffness"] = number_or_null(critical.stiffness);
  document["critical_frequency_rad_s"] = critical.limit ? Json(critical.limit->frequency) : Json(nullptr);
  document["limited_by"] = critical.limit ? mechanism_json(critical.limit->limited_by) : Json(nullptr);
  document["any_user_stiffness"] = any_user ? number_or_null(any_user->stiffness) : Json(nullptr);
  document["sensitivities"] = Json::array();
  for (const Sensitivity& each : designed.sensitivities) {
    document["sensitivities"].push_back(to_json(each.key, each.value, designed));
  }
  for (const Sensitivity& each : designed.any_user) {
    if (find_sensitivity(designed.sensitivities, each.key) != nullptr) continue;
    document["sensitivities"].push_back(to_json(each.key, each.value, designed));
  }
  document["branch_switches"] = designed.branch_switches ? Json::array() : Json(nullptr);
  if (designed.branch_switches) {
    for (const BranchSwitch& each : *designed.branch_switches) document["branch_switches"].push_back(to_json(each));
  }
  return document;
}

}  // namespace zwidth::report
