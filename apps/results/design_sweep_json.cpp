#include "results/design_sweep_json.hpp"

#include "report/designed_device.hpp"
#include "report/text/quantity.hpp"
#include "results/json_value.hpp"

namespace zwidth::report {
namespace {

using Json = results::Json;

Json to_json(const SweepPoint& point) {
  Json json{{"status", status_name(point.status)},
            {"critical_stiffness", number_or_null(point.stiffness)},
            {"frequency_rad_s", point.limit ? Json(point.limit->frequency) : Json(nullptr)},
            {"limited_by", point.limit ? mechanism_json(point.limit->limited_by) : Json(nullptr)},
            {"any_user_stiffness", point.any_user ? number_or_null(point.any_user->stiffness) : Json(nullptr)}};
  return json;
}

}  // namespace

results::Json sweep_json(const DesignSweep& design) {
  const DeviceParameters& device = design.device.parameters();
  Json document;
  document["schema"] = "zwidth.design_sweep/1";
  document["device"] = device.name;
  document["units"] = {{"stiffness", units_of(device.motion).stiffness}};
  document["axes"] = Json::array();
  for (std::size_t i = 0; i < design.sweep.axes.size(); ++i) {
    const std::string& key = design.sweep.axes[i].key;
    document["axes"].push_back(
        {{"parameter", key}, {"unit", parameter_unit(key, device.motion)}, {"values", design.sweep.values[i]}});
  }
  document["points"] = Json::array();
  for (const SweepPoint& point : design.sweep.points) document["points"].push_back(to_json(point));
  return document;
}

}  // namespace zwidth::report
