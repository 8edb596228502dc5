#include "results/simulation_json.hpp"

#include <optional>

#include "report/text/quantity.hpp"
#include "results/analysis_json.hpp"
#include "results/json_value.hpp"
#include "results/wall_filter_json.hpp"

namespace zwidth::report {
namespace {

using Json = results::Json;

Json wall_json(const SimulatedLoop& loop) {
  const ControllerOptions& wall = loop.options.loop.controller;
  const DeviceParameters& device = loop.analysed.device.parameters();
  if (wall.kind != ControllerOptions::Kind::wall) return nullptr;
  return {{"stiffness", wall.stiffness},
          {"damping", wall.damping},
          {"velocity_filter_hz", wall.velocity_filter_hz},
          {"filters", results::wall_filters_json(device.wall, device.loop.sampling_period)},
          {"position", wall.position},
          {"contact", wall.contact == ControllerOptions::Contact::unilateral ? "unilateral" : "bilateral"}};
}

Json start_json(const SimulatedLoop& loop) {
  const HybridLoopOptions& options = loop.options.loop;
  Json bodies = Json::array();
  for (std::size_t i = 0; i < loop.analysed.device.bodies().size(); ++i) {
    bodies.push_back({{"body", loop.analysed.device.bodies()[i].name},
                      {"position", options.initial_position.empty() ? 0.0 : options.initial_position[i]},
                      {"velocity", options.initial_velocity.empty() ? 0.0 : options.initial_velocity[i]}});
  }
  return bodies;
}

Json user_force_json(const UserForce& force) {
  switch (force.kind) {
    case UserForce::Kind::none:
      break;
    case UserForce::Kind::step:
      return {{"kind", "step"}, {"force", force.amplitude}, {"start_s", force.start}};
    case UserForce::Kind::ramp:
      return {{"kind", "ramp"}, {"force_per_s", force.amplitude}, {"start_s", force.start}};
    case UserForce::Kind::sine:
      return {{"kind", "sine"},
              {"amplitude", force.amplitude},
              {"frequency_hz", hertz(force.frequency)},
              {"start_s", force.start}};
    case UserForce::Kind::recorded:
      return {{"kind", "recorded"},
              {"samples", force.samples.size()},
              {"period_s", force.period},
              {"start_s", force.start}};
  }
  return nullptr;
}

Json faults_json(const Faults& faults) {
  return {{"lost_sample_probability", faults.lost_sample_probability},
          {"sampling_jitter_s", faults.sampling_jitter},
          {"overrun_probability", faults.overrun_probability},
          {"overrun_delay_s", faults.overrun_delay},
          {"seed", faults.seed}};
}

Json oscillation_json(const std::optional<Oscillation>& oscillation) {
  if (!oscillation) return nullptr;
  return {{"frequency_rad_s", oscillation->frequency},
          {"frequency_hz", hertz(oscillation->frequency)},
          {"amplitude", number_or_null(oscillation->amplitude)}};
}

Json linear_json(const AnalysedDevice& analysed) {
  const Json analysis = results::analysis_json(analysed);
  const std::optional<WallMargins>& wall = analysed.analysis.wall;
  const bool finite = analysed.analysis.critical.status == StiffnessStatus::finite;
  return {{"status", analysis.at("status")},
          {"critical_stiffness", analysis.at("critical_stiffness")},
          {"critical_frequency_rad_s", analysis.at("critical_frequency_rad_s")},
          {"critical_frequency_hz", analysis.at("critical_frequency_hz")},
          {"wall_share", wall && finite ? Json(wall->stiffness / analysed.analysis.critical.stiffness) : Json(nullptr)},
          {"wall_stable", wall ? Json(wall->stable) : Json(nullptr)}};
}

}  // namespace

results::Json simulation_json(const SimulatedLoop& loop) {
  const Simulation& result = loop.result;
  const Device& device = loop.analysed.device;
  const Units units = units_of(device.parameters().motion);
  const bool has_wall = result.generated_energy.has_value();
  Json document;
  document["schema"] = "zwidth.simulation/1";
  document["device"] = device.name();
  document["units"] = {{"length", units.length},
                       {"force", units.force},
                       {"stiffness", units.stiffness},
                       {"damping", units.damping},
                       {"energy", "J"}};
  document["sampling_period_s"] = device.loop().sampling_period;
  document["duration_s"] = static_cast<double>(result.samples) * device.loop().sampling_period;
  document["samples"] = result.samples;
  document["wall"] = wall_json(loop);
  document["start"] = start_json(loop);
  document["user_force"] = user_force_json(loop.options.loop.user_force);
  document["faults"] = faults_json(loop.options.loop.faults);
  document["verdict"] = verdict_name(result.verdict);
  document["oscillation"] = oscillation_json(result.oscillation);
  document["growth_rate_per_s"] = number_or_null(result.growth_rate);
  document["settling_time_s"] = number_or_null(result.settling_time);
  document["final_position"] = number_or_null(result.final_position);
  document["peak_penetration"] = has_wall ? number_or_null(result.peak_penetration) : Json(nullptr);
  document["generated_energy"] = number_or_null(result.generated_energy);
  document["peak_generated_energy"] = has_wall ? number_or_null(result.peak_generated_energy) : Json(nullptr);
  document["stick_slip_instants"] = result.friction_events;
  document["linear"] = linear_json(loop.analysed);
  document["remarks"] = loop.remarks;
  return document;
}

}  // namespace zwidth::report
