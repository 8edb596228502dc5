#include "results/analysis_json.hpp"

#include <cmath>
#include <optional>

#include "report/text/quantity.hpp"
#include "results/json_value.hpp"
#include "results/wall_filter_json.hpp"

namespace zwidth::report {
namespace {

using Json = nlohmann::ordered_json;

Json decibels_or_null(std::optional<double> value) {
  return value && *value > 0.0 ? number_or_null(decibels(*value)) : Json(nullptr);
}

Json to_json(const Crossover& crossover) {
  return {{"frequency_rad_s", crossover.frequency},
          {"stiffness", crossover.stiffness},
          {"limited_by", mechanism_json(crossover.limited_by)},
          {"poles_leaving", crossover.poles_leaving}};
}

Json to_json(const Mode& mode) {
  return {{"frequency_rad_s", mode.frequency},
          {"frequency_hz", hertz(mode.frequency)},
          {"damping_ratio", number_or_null(mode.damping_ratio)}};
}

Json to_json(const StableInterval& interval) { return Json::array({interval.lower, number_or_null(interval.upper)}); }

Json to_json(const RigidApproximation& rigid) {
  return {{"mass", rigid.mass},
          {"damping", rigid.damping},
          {"critical_stiffness", number_or_null(rigid.critical.stiffness)},
          {"stiffness", rigid.stiffness},
          {"status", status_name(rigid.critical.status)}};
}

Json to_json(const QCriterion& criterion) {
  return {{"stiffness", number_or_null(criterion.stiffness)},
          {"db", decibels_or_null(criterion.stiffness)},
          {"mode_matters", criterion.mode_matters ? Json(*criterion.mode_matters) : Json(nullptr)}};
}

Json to_json(const WallMargins& wall) {
  return {{"stiffness", wall.stiffness},
          {"damping", wall.damping},
          {"stable", wall.stable},
          {"gain_margin_db", decibels_or_null(wall.gain_margin)},
          {"phase_margin_rad", number_or_null(wall.phase_margin)},
          {"delay_margin_s", number_or_null(wall.delay_margin)},
          {"spectral_radius", number_or_null(wall.spectral_radius)},
          {"lower_gain_margin_db", decibels_or_null(wall.lower_gain_margin)}};
}

Json to_json(const StiffnessInterval& interval) {
  return Json::array({interval.lower, number_or_null(interval.upper)});
}

Json to_json(const WorstUser& worst) {
  Json absorbers = Json::array();
  for (const auto& [mass, stiffness] : worst.user.absorbers) {
    absorbers.push_back(Json{{"mass", mass}, {"stiffness", stiffness}});
  }
  return {{"mass", worst.user.mass},
          {"damping", 0.0},
          {"stiffness", worst.user.stiffness},
          {"absorbers", absorbers},
          {"critical_stiffness", worst.critical_stiffness},
          {"frequency_rad_s", worst.frequency}};
}

Json to_json(const ValueRange& range) { return Json::array({range.least, range.greatest}); }

Json to_json(const UserFamilyAnswer& answer) {
  const Operator& user = answer.worst.user;
  return {{"mass", to_json(answer.family.mass)},
          {"damping", to_json(answer.family.damping)},
          {"stiffness", to_json(answer.family.stiffness)},
          {"worst_user", {{"mass", user.mass}, {"damping", user.damping}, {"stiffness", user.stiffness}}},
          {"critical_stiffness", number_or_null(answer.worst.critical_stiffness)},
          {"free_critical_stiffness", number_or_null(answer.free.stiffness)}};
}

template <typename T>
Json to_json_or_null(const std::optional<T>& value) {
  return value ? to_json(*value) : Json(nullptr);
}

template <typename T>
Json to_json_array(const std::vector<T>& values) {
  Json array = Json::array();
  for (const T& value : values) array.push_back(to_json(value));
  return array;
}

Json any_user_json(const AnalysedDevice& analysed) {
  if (!analysed.any_user) return nullptr;
  const AnyUserLimit& limit = *analysed.any_user;
  return {{"critical_stiffness", number_or_null(limit.stiffness)},
          {"frequency_rad_s",
           limit.stiffness > 0.0 && std::isfinite(limit.stiffness) ? Json(limit.frequency) : Json(nullptr)},
          {"truncation", limit.truncation},
          {"worst_user", to_json_or_null(analysed.worst_user)}};
}

}  // namespace

nlohmann::ordered_json analysis_json(const AnalysedDevice& analysed) {
  const DeviceParameters& device = analysed.device.parameters();
  const Analysis& analysis = analysed.analysis;
  const CriticalStiffness& critical = analysis.critical;
  const Units units = units_of(device.motion);
  std::optional<double> frequency;
  if (critical.limit) frequency = critical.limit->frequency;

  Json document;
  document["schema"] = "zwidth.analysis/1";
  document["device"] = device.name;
  document["units"] = {{"stiffness", units.stiffness}, {"damping", units.damping}};
  document["status"] = status_name(critical.status);
  document["critical_stiffness"] = number_or_null(critical.stiffness);
  document["critical_stiffness_db"] = decibels_or_null(critical.stiffness);
  document["critical_frequency_rad_s"] = number_or_null(frequency);
  document["critical_frequency_hz"] = frequency ? number_or_null(hertz(*frequency)) : Json(nullptr);
  document["limited_by"] = critical.limit ? mechanism_json(critical.limit->limited_by) : Json(nullptr);
  document["stable_intervals"] = to_json_array(critical.stable_intervals);
  document["crossovers"] = to_json_array(critical.crossovers);
  document["modes"] = to_json_array(analysis.modes);
  document["suspended_rigid_body"] = to_json_or_null(analysis.suspended_rigid_body);
  document["rigid_approximation"] = to_json_or_null(analysis.rigid);
  document["q_criterion"] = to_json_or_null(analysis.q_criterion);
  document["any_user"] = any_user_json(analysed);
  document["user_family"] = to_json_or_null(analysed.user_family);
  document["virtual_damper"] = device.wall.damping > 0.0 ? Json{{"damping", device.wall.damping},
                                                                {"velocity_filter_hz", device.wall.velocity_filter_hz}}
                                                         : Json(nullptr);
  document["wall_filters"] = wall_filters_json(device.wall, device.loop.sampling_period);
  document["wall"] = to_json_or_null(analysis.wall);
  document["critical_stiffness_interval"] = to_json_or_null(analysis.interval);
  document["other_mechanism_share"] = analysis.interval ? Json(analysis.interval->other_mechanism) : Json(nullptr);
  document["uncertainty_warning"] =
      device.uncertainty && !device.uncertainty->warning.empty() ? Json(device.uncertainty->warning) : Json(nullptr);
  return document;
}

}  // namespace zwidth::report
