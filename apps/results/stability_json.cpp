#include "results/stability_json.hpp"

#include "results/units.hpp"

namespace zwidth::results {

void to_json(Json& json, const Oscillator& oscillator) {
  json = {{"kind", oscillator.kind}};
  if (oscillator.kind == Oscillator::Kind::vibration_mode) json["mode"] = oscillator.mode;
}

void to_json(Json& json, const Crossover& crossover) {
  json = {{"frequency_rad_s", crossover.frequency}, {"frequency_hz", hertz(crossover.frequency)},
          {"stiffness", crossover.stiffness},       {"stiffness_db", decibels(std::optional(crossover.stiffness))},
          {"limited_by", crossover.limited_by},     {"poles_leaving", crossover.poles_leaving}};
}

void to_json(Json& json, const StableInterval& interval) { json = Json::array({interval.lower, interval.upper}); }

void to_json(Json& json, const StiffnessInterval& interval) { json = Json::array({interval.lower, interval.upper}); }

void to_json(Json& json, const Mode& mode) {
  json = {{"frequency_rad_s", mode.frequency},
          {"frequency_hz", hertz(mode.frequency)},
          {"damping_ratio", mode.damping_ratio}};
}

void to_json(Json& json, const RigidApproximation& rigid) {
  json = {{"mass", rigid.mass},
          {"damping", rigid.damping},
          {"critical_stiffness", rigid.critical.stiffness},
          {"stiffness", rigid.stiffness},
          {"status", rigid.critical.status},
          {"error", rigid.error}};
}

void to_json(Json& json, const QCriterion& criterion) {
  json = {{"stiffness", criterion.stiffness},
          {"db", decibels(std::optional(criterion.stiffness))},
          {"mode_matters", criterion.mode_matters},
          {"is_similar", criterion.is_similar}};
}

void to_json(Json& json, const WallMargins& wall) {
  json = {{"stiffness", wall.stiffness},
          {"damping", wall.damping},
          {"stable", wall.stable},
          {"gain_margin_db", decibels(wall.gain_margin)},
          {"phase_margin_rad", wall.phase_margin},
          {"delay_margin_s", wall.delay_margin},
          {"spectral_radius", wall.spectral_radius},
          {"lower_gain_margin_db", decibels(wall.lower_gain_margin)},
          {"stiffness_margin_db", decibels(wall.stiffness_margin)}};
}

void to_json(Json& json, const DiskMargin& disk) {
  json = {{"alpha", disk.alpha},
          {"gain_margin_db", decibels(disk.gain_margin)},
          {"lower_gain_margin_db", decibels(disk.lower_gain_margin)},
          {"phase_margin_rad", disk.phase_margin},
          {"frequency_rad_s", disk.frequency},
          {"frequency_hz", hertz(disk.frequency)},
          {"worst_factor", nullptr}};
  if (disk.worst_factor) json["worst_factor"] = Json::array({disk.worst_factor->real(), disk.worst_factor->imag()});
}

void to_json(Json& json, const WorstUser& worst) {
  Json absorbers = Json::array();
  for (const auto& [mass, stiffness] : worst.user.absorbers) {
    absorbers.push_back({{"mass", mass}, {"stiffness", stiffness}});
  }
  json = {{"mass", worst.user.mass},
          {"damping", 0.0},
          {"stiffness", worst.user.stiffness},
          {"absorbers", std::move(absorbers)},
          {"critical_stiffness", worst.critical_stiffness},
          {"frequency_rad_s", worst.frequency}};
}

void to_json(Json& json, const HolderLimit& limit) {
  json = {{"critical_stiffness", limit.critical_stiffness},
          {"frequency_rad_s", limit.frequency},
          {"limited_by", limit.limited_by},
          {"critical_damping", limit.critical_damping},
          {"critical_damping_frequency_rad_s", limit.damping_frequency},
          {"critical_damping_limited_by", limit.damping_limited_by}};
}

void to_json(Json& json, const HoldingLimits& limits) {
  json = {{"nobody", limits.nobody}, {"user", limits.user}, {"any_user", limits.any_user}};
}

void to_json(Json& json, const StableFor& wall) {
  json = {{"nobody", wall.nobody}, {"user", wall.user}, {"any_user", wall.any_user}};
}

void add_critical(Json& document, const CriticalStiffness& critical) {
  std::optional<double> frequency;
  std::optional<Oscillator> limited_by;
  if (critical.limit) {
    frequency = critical.limit->frequency;
    limited_by = critical.limit->limited_by;
  }
  document["status"] = critical.status;
  document["critical_stiffness"] = critical.stiffness;
  document["critical_stiffness_db"] = decibels(std::optional(critical.stiffness));
  document["critical_frequency_rad_s"] = frequency;
  document["critical_frequency_hz"] = hertz(frequency);
  document["limited_by"] = limited_by;
}

}  // namespace zwidth::results
