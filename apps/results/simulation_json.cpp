#include "results/simulation_json.hpp"

#include <optional>

#include "results/csv.hpp"
#include "results/stability_json.hpp"
#include "results/units.hpp"
#include "results/wall_filter_json.hpp"

namespace zwidth::results {

static void to_json(Json& json, const Oscillation& oscillation) {
  json = {{"frequency_rad_s", oscillation.frequency},
          {"frequency_hz", hertz(oscillation.frequency)},
          {"amplitude", oscillation.amplitude}};
}

static void to_json(Json& json, const QuantisationForce& quantisation_force) {
  json = {{"amplitude", quantisation_force.amplitude},
          {"frequency_rad_s", quantisation_force.frequency},
          {"frequency_hz", hertz(quantisation_force.frequency)}};
}

static void to_json(Json& json, const Faults& faults) {
  json = {{"lost_sample_probability", faults.lost_sample_probability},
          {"sampling_jitter_s", faults.sampling_jitter},
          {"overrun_probability", faults.overrun_probability},
          {"overrun_delay_s", faults.overrun_delay},
          {"seed", faults.seed}};
}

static void to_json(Json& json, const LinearAnswer& linear) {
  const auto frequency =
      linear.critical.limit ? std::optional(linear.critical.limit->frequency) : std::optional<double>();
  json = {{"status", linear.critical.status},
          {"critical_stiffness", linear.critical.stiffness},
          {"critical_frequency_rad_s", frequency},
          {"critical_frequency_hz", hertz(frequency)},
          {"wall_share", linear.wall_share},
          {"wall_stable", linear.wall_stable},
          {"limits", linear.limits},
          {"stable_for", linear.stable_for},
          {"agrees", linear.agrees}};
}

static void to_json(Json& json, const UserForce& force) {
  switch (force.kind) {
    case UserForce::Kind::none:
      json = nullptr;
      return;
    case UserForce::Kind::step:
      json = {{"kind", "step"}, {"force", force.amplitude}, {"start_s", force.start}};
      return;
    case UserForce::Kind::ramp:
      json = {{"kind", "ramp"}, {"force_per_s", force.amplitude}, {"start_s", force.start}};
      return;
    case UserForce::Kind::sine:
      json = {{"kind", "sine"},
              {"amplitude", force.amplitude},
              {"frequency_hz", hertz(force.frequency)},
              {"start_s", force.start}};
      return;
    case UserForce::Kind::recorded:
      json = {{"kind", "recorded"},
              {"samples", force.samples.size()},
              {"period_s", force.period},
              {"start_s", force.start}};
      return;
  }
}

namespace {

Json wall_json(const Device& device, const ControllerOptions& wall) {
  if (wall.kind != ControllerOptions::Kind::wall) return nullptr;
  return {{"stiffness", wall.stiffness},
          {"damping", wall.damping},
          {"velocity_filter_hz", wall.velocity_filter_hz},
          {"filters", wall_filters_json(Wall{{}, 0.0, 0.0, wall.filters}, device.loop().sampling_period)},
          {"position", wall.position},
          {"contact", wall.contact == ControllerOptions::Contact::unilateral ? "unilateral" : "bilateral"}};
}

Json start_json(const Device& device, const HybridLoopOptions& loop) {
  Json bodies = Json::array();
  for (std::size_t i = 0; i < device.bodies().size(); ++i) {
    bodies.push_back({{"body", device.bodies()[i].name},
                      {"position", loop.initial_position.empty() ? 0.0 : loop.initial_position[i]},
                      {"velocity", loop.initial_velocity.empty() ? 0.0 : loop.initial_velocity[i]}});
  }
  return bodies;
}

Json points_json(const Device& device, const Trajectory& kept) {
  Json bodies = Json::array();
  for (std::size_t i = 0; i < device.bodies().size(); ++i) {
    bodies.push_back(
        {{"body", device.bodies()[i].name}, {"position", kept.position[i]}, {"velocity", kept.velocity[i]}});
  }
  Json points = {{"time_s", kept.time},
                 {"measured", kept.measured},
                 {"command", kept.command},
                 {"user_force", kept.user_force},
                 {"bodies", bodies}};
  if (!device.has_bodies()) points["position"] = kept.position.front();
  return points;
}

}  // namespace

Json simulation_json(const Device& device, const Simulation& result, PointsInJson points) {
  const Units units = units_of(device.parameters().motion);
  const bool has_wall = result.generated_energy.has_value();
  Json json = document("zwidth.simulation/1");
  json["device"] = device.name();
  json["units"] = {{"length", units.length},
                   {"force", units.force},
                   {"stiffness", units.stiffness},
                   {"damping", units.damping},
                   {"energy", "J"}};
  json["sampling_period_s"] = device.loop().sampling_period;
  json["duration_s"] = static_cast<double>(result.samples) * device.loop().sampling_period;
  json["samples"] = result.samples;
  json["wall"] = wall_json(device, result.loop.controller);
  json["start"] = start_json(device, result.loop);
  json["user_force"] = result.loop.user_force;
  json["faults"] = result.loop.faults;
  json["verdict"] = result.verdict;
  json["oscillation"] = result.oscillation;
  json["growth_rate_per_s"] = result.growth_rate;
  json["settling_time_s"] = result.settling_time;
  json["final_position"] = result.final_position;
  json["peak_penetration"] = has_wall ? Json(result.peak_penetration) : Json(nullptr);
  json["generated_energy"] = result.generated_energy;
  json["peak_generated_energy"] = has_wall ? Json(result.peak_generated_energy) : Json(nullptr);
  json["force_ripple"] = result.quantisation_force;
  json["encoder_chatters"] = result.encoder_chatters;
  json["stick_slip_instants"] = result.friction_events;
  json["nonlinear_parts"] = result.nonlinear_parts;
  json["linear"] = result.linear;
  add_findings(json, result);
  if (points == PointsInJson::included) json["points"] = points_json(device, result.trajectory);
  return json;
}

std::string simulation_csv(const Device& device, const Simulation& result) {
  const Trajectory& kept = result.trajectory;
  Csv rows;
  for (const char* name : {"time_s", "measured", "command", "user_force"}) rows.cell(name);
  for (const Body& body : device.bodies()) {
    rows.cell(body.name + ".position");
    rows.cell(body.name + ".velocity");
  }
  if (!device.has_bodies()) rows.cell("position");
  rows.cell("trust");
  rows.end_row();
  for (std::size_t k = 0; k < kept.time.size(); ++k) {
    for (const auto* column : {&kept.time, &kept.measured, &kept.command, &kept.user_force}) rows.cell((*column)[k]);
    for (std::size_t i = 0; i < kept.position.size(); ++i) {
      rows.cell(kept.position[i][k]);
      if (i < kept.velocity.size()) rows.cell(kept.velocity[i][k]);
    }
    rows.cell(result.trust);
    rows.end_row();
  }
  return rows.text();
}

}  // namespace zwidth::results
