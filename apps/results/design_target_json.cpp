#include "results/design_target_json.hpp"

#include "results/drive_damper_json.hpp"
#include "results/units.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::results {

Json design_target_json(const Device& device, const DesignTargetOptions& options, const DesignTargets& targets) {
  Json json = document("zwidth.design_target/1");
  json["device"] = device.name();
  json["units"] = wall_units(device.parameters().motion);
  json["limits"] = targets.limits;
  const bool any_user = options.goal == StiffnessGoal::absolute_stability_limit;
  const bool is_damper = options.limit_of == WallNumber::damping;
  json["goal"] = is_damper ? (any_user ? "any_user_damping" : "critical_damping")
                           : (any_user ? "any_user_limit" : "critical_stiffness");
  json["target"] = options.times_now ? Json(targets.target) : Json(options.stiffness);
  json["stiffness_now"] = is_damper ? std::nullopt : targets.limit_now;
  json["damping_now"] = is_damper ? targets.limit_now : std::nullopt;
  json["any_user_now"] = targets.absolute_stability_limit_now;
  add_findings(json, targets);
  json["targets"] = Json::array();
  for (const DesignTarget& each : targets.targets) {
    json["targets"].push_back(Json{{"parameter", each.key},
                                   {"value_now", each.value_now},
                                   {"value_needed", Json(each.value_needed)},
                                   {"why", text(each.why)},
                                   {"any_user_then", each.absolute_stability_limit_then},
                                   {"safe", each.safe}});
  }
  json["drive_damper"] = targets.drive_damper;
  return json;
}

}  // namespace zwidth::results
