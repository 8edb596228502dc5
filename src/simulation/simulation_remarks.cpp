#include "simulation/simulation_remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "simulation/simulation_setup.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

constexpr double on_circle = 1e-9;        // | |z| - 1 | of a pole that may be on the unit circle
constexpr double steps_of_chatter = 2.0;  // encoder steps: a swing of so much, either way, is of the encoder's making

bool has_wall(const Simulation& result) { return result.loop.controller.kind == ControllerOptions::Kind::wall; }

bool only_pushes(const Simulation& result) {
  return has_wall(result) && result.loop.controller.contact == ControllerOptions::Contact::unilateral;
}

std::vector<NonlinearPart> nonlinear_parts(const Simulation& result, const Device& device) {
  const DeviceParameters& parameters = device.parameters();
  const Faults& faults = result.loop.faults;
  std::vector<NonlinearPart> parts;
  const auto add = [&parts](bool acts, NonlinearPart part) {
    if (acts) parts.push_back(part);
  };
  add(whole_friction(device) > 0.0, NonlinearPart::coulomb_friction);
  add(parameters.sensor.resolution > 0.0, NonlinearPart::quantisation_step);
  add(parameters.actuator.force_limit.has_value(), NonlinearPart::force_limit);
  add(result.loop.controller.contact == ControllerOptions::Contact::unilateral, NonlinearPart::leaving_wall);
  add(faults.lost_sample_probability > 0.0, NonlinearPart::lost_samples);
  add(faults.sampling_jitter > 0.0, NonlinearPart::sampling_jitter);
  add(faults.overrun_probability > 0.0, NonlinearPart::late_forces);
  return parts;
}

/// Linear analysis finds a pole outside the unit circle, and nothing in the loop could hold its oscillation down: an
/// encoder's step does not.
bool must_grow(const Simulation& result) {
  const auto is_encoder = [](NonlinearPart part) { return part == NonlinearPart::quantisation_step; };
  return has_wall(result) && result.loop.controller.stiffness > 0.0 && !result.linear.wall_stable.value_or(true) &&
         result.linear.spectral_radius.value_or(0.0) > 1.0 &&
         std::all_of(result.nonlinear_parts.begin(), result.nonlinear_parts.end(), is_encoder);
}

/// Nothing in the loop keeps an oscillation up that neither grows nor dies out: it is linear, and no pole is on the unit circle.
bool cannot_swing_on(const Simulation& result) {
  return has_wall(result) && result.loop.controller.stiffness > 0.0 && result.nonlinear_parts.empty() &&
         result.linear.spectral_radius && std::abs(*result.linear.spectral_radius - 1.0) > on_circle;
}

/// Whether the motion at the end is so small, or so steady a drift, that the encoder's steps are what moves the force.
bool chatters(const Simulation& result, const Device& device, std::span<const double> sensed) {
  if (!result.quantisation_force) return false;
  if (result.verdict == LoopVerdict::drifts) return true;
  if (result.verdict != LoopVerdict::settles && result.verdict != LoopVerdict::limit_cycle) return false;
  const auto end = sensed.last(sensed.size() / 4);
  const auto [low, high] = std::minmax_element(end.begin(), end.end());
  return *high - *low <= 2.0 * steps_of_chatter * device.parameters().sensor.resolution;
}

void remark_wall(std::vector<Remark>& remarks, const Simulation& result, const Device& device) {
  if (!has_wall(result)) {
    remarks.push_back(note({.code = FindingCode::no_wall, .key = "wall.stiffness"}));
    return;
  }
  if (!only_pushes(result)) return;
  if (result.peak_penetration == 0.0) {
    remarks.push_back(warning({.code = FindingCode::never_touches_wall}));
  }
  const std::vector<double>& starts = result.loop.initial_position;
  const double depth = (starts.empty() ? 0.0 : starts[device.loop().sensed]) - result.loop.controller.position;
  if (depth > 0.0) {
    const Units units = units_of(device.parameters().motion);
    remarks.push_back(note({.code = FindingCode::starts_inside_wall, .evidence = {{"depth", depth, units.length}}}));
  }
}

void remark_linearised(std::vector<Remark>& remarks, const Device& device) {
  const std::optional<Coordinates>& of = device.parameters().coordinates;
  if (!of) return;
  if (of->frictions.empty()) {
    remarks.push_back(note({.code = FindingCode::motion_linearised}));
    return;
  }
  double largest = 0.0;
  for (const Coordinates::Friction& each : of->frictions) largest = std::max(largest, each.force);
  remarks.push_back(
      warning({.code = FindingCode::friction_left_out,
               .evidence = {{"rubbing", static_cast<double>(of->frictions.size())}, {"largest", largest}}}));
}

bool never_moves(std::span<const double> sensed) {
  return std::ranges::all_of(sensed, [&](double each) { return each == sensed.front(); });
}

/// Friction that never lets go of the device.
void remark_stiction(std::vector<Remark>& remarks, const Simulation& result, const Device& device,
                     std::span<const double> sensed) {
  if (!never_moves(sensed) || whole_friction(device) == 0.0) return;
  const Units units = units_of(device.parameters().motion);
  const double friction = whole_friction(device);
  Finding finding{.code = FindingCode::never_moves_when_pushed, .evidence = {{"friction", friction, units.force}}};
  if (result.loop.user_force.kind == UserForce::Kind::none && has_wall(result)) {
    const auto further = start_beyond_stiction(device, result.loop.controller);
    finding.code = further ? FindingCode::never_moves_from_start : FindingCode::never_moves_under_force_limit;
    if (further) finding.evidence.push_back({"start", *further, units.length});
  }
  remarks.push_back(warning(std::move(finding)));
}

/// A wall that could not act, whatever its stiffness.
void remark_idle_wall(std::vector<Remark>& remarks, const Simulation& result, const Device& device,
                      std::span<const double> sensed) {
  if (!has_wall(result)) return;
  const Units units = units_of(device.parameters().motion);
  const double friction = whole_friction(device);
  const double limit = device.parameters().actuator.force_limit.value_or(std::numeric_limits<double>::infinity());
  if (friction >= limit && !never_moves(sensed) && result.loop.user_force.kind == UserForce::Kind::none) {
    remarks.push_back(warning({.code = FindingCode::force_limit_below_friction,
                               .evidence = {{"force_limit", limit, units.force}, {"friction", friction, units.force}},
                               .key = "actuator.force_limit"}));
  }
  const double step = device.parameters().sensor.resolution;
  const auto count = [&](double position) { return std::round((position - result.loop.controller.position) / step); };
  if (step > 0.0 && std::ranges::all_of(sensed, [&](double each) { return count(each) == count(sensed.front()); })) {
    remarks.push_back(warning({.code = FindingCode::encoder_stands_still,
                               .evidence = {{"resolution", step, units.length}},
                               .key = "sensor.resolution"}));
  }
}

void remark_encoder(std::vector<Remark>& remarks, const Simulation& result, const Device& device) {
  if (!result.encoder_chatters) return;
  const Units units = units_of(device.parameters().motion);
  const QuantisationForce& quantisation_force = *result.quantisation_force;
  const bool is_damped = result.loop.controller.damping > 0.0;
  const bool drifts = result.verdict == LoopVerdict::drifts;
  using enum FindingCode;
  remarks.push_back(warning({.code = drifts ? (is_damped ? encoder_ripple_of_damper_in_drift : encoder_ripple_in_drift)
                                            : (is_damped ? encoder_ripple_of_damper : encoder_ripple),
                             .evidence = {{"resolution", device.parameters().sensor.resolution, units.length},
                                          {"force_amplitude", quantisation_force.amplitude, units.force},
                                          {"frequency", hertz(quantisation_force.frequency), "Hz"}},
                             .key = "sensor.resolution"}));
}

void remark_run(std::vector<Remark>& remarks, const Simulation& result, const Device& device,
                const SimulationOptions& options) {
  const Units units = units_of(device.parameters().motion);
  const double simulated = static_cast<double>(result.samples) * device.loop().sampling_period;
  if (result.diverged && simulated < result.duration - device.loop().sampling_period) {
    remarks.push_back(
        note({.code = FindingCode::run_ended_early,
              .evidence = {{"simulated", simulated, "s"}, {"position", options.divergence, units.length}}}));
  }
  const UserForce& force = result.loop.user_force;
  if (force.kind == UserForce::Kind::recorded) {
    const double length = force.period * static_cast<double>(force.samples.size() - 1);
    if (length > 0.5 * (result.duration - force.start)) {
      remarks.push_back(note({.code = FindingCode::force_acts_to_the_end,
                              .evidence = {{"length", length}, {"duration", result.duration}}}));
    }
  }
  if (result.verdict == LoopVerdict::undecided) {
    const bool grows = must_grow(result);
    Finding finding{.code = grows ? FindingCode::growth_not_seen : FindingCode::few_oscillations};
    if (grows) finding.evidence.push_back({"spectral_radius", *result.linear.spectral_radius});
    remarks.push_back(warning(std::move(finding)));
  }
  if (result.overloaded_steps > 0) {
    remarks.push_back(warning({.code = FindingCode::stick_slip_not_followed,
                               .evidence = {{"steps", static_cast<double>(result.overloaded_steps)}}}));
  }
}

}  // namespace

void compare_with_linear(Simulation& result, const Device& device, std::span<const double> sensed) {
  result.nonlinear_parts = nonlinear_parts(result, device);
  const bool is_quiet = result.verdict == LoopVerdict::settles || result.verdict == LoopVerdict::forced;
  if (is_quiet && must_grow(result)) result.verdict = LoopVerdict::undecided;
  if (result.verdict == LoopVerdict::limit_cycle && cannot_swing_on(result)) result.verdict = LoopVerdict::undecided;
  if (result.linear.wall_stable && result.verdict != LoopVerdict::undecided) {
    const bool moves_on = result.verdict == LoopVerdict::limit_cycle || result.verdict == LoopVerdict::unstable;
    result.linear.agrees = *result.linear.wall_stable != moves_on;
  }
  result.encoder_chatters = chatters(result, device, sensed);
}

std::vector<Remark> simulation_remarks(const Simulation& result, const Device& device, const SimulationOptions& options,
                                       std::span<const double> sensed) {
  std::vector<Remark> remarks;
  remark_wall(remarks, result, device);
  remark_linearised(remarks, device);
  remark_run(remarks, result, device, options);
  remark_stiction(remarks, result, device, sensed);
  remark_idle_wall(remarks, result, device, sensed);
  remark_encoder(remarks, result, device);
  return remarks;
}

}  // namespace zwidth::internal
