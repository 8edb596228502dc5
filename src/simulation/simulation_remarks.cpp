#include "simulation/simulation_remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "simulation/simulation_setup.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

constexpr double steps_of_chatter = 2.0;  // encoder steps: a swing of so much, either way, is of the encoder's making

Remark note(std::string what, std::string consequence, std::string remedy = {}) {
  return {Remark::Severity::note, std::move(what), std::move(consequence), std::move(remedy)};
}

Remark warning(std::string what, std::string consequence, std::string remedy = {}) {
  return {Remark::Severity::warning, std::move(what), std::move(consequence), std::move(remedy)};
}

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
  add(parameters.sensor.resolution > 0.0, NonlinearPart::encoder_step);
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
  const auto is_encoder = [](NonlinearPart part) { return part == NonlinearPart::encoder_step; };
  return has_wall(result) && result.loop.controller.stiffness > 0.0 && result.linear.spectral_radius &&
         *result.linear.spectral_radius > 1.0 &&
         std::all_of(result.nonlinear_parts.begin(), result.nonlinear_parts.end(), is_encoder);
}

/// Whether the motion at the end is so small, or so steady a drift, that the encoder's steps are what moves the force.
bool chatters(const Simulation& result, const Device& device, std::span<const double> sensed) {
  if (!result.force_ripple) return false;
  if (result.verdict == LoopVerdict::drifts) return true;
  if (result.verdict != LoopVerdict::settles && result.verdict != LoopVerdict::limit_cycle) return false;
  const auto end = sensed.last(sensed.size() / 4);
  const auto [low, high] = std::minmax_element(end.begin(), end.end());
  return *high - *low <= 2.0 * steps_of_chatter * device.parameters().sensor.resolution;
}

void remark_wall(std::vector<Remark>& remarks, const Simulation& result, const Device& device) {
  if (!has_wall(result)) {
    remarks.push_back(note("there is no wall: the device moves freely", "", "set wall.stiffness to render one"));
    return;
  }
  if (!only_pushes(result)) return;
  if (result.peak_penetration == 0.0) {
    remarks.push_back(warning("the device never touches the wall", "the verdict is about the free device"));
  }
  const std::vector<double>& starts = result.loop.initial_position;
  const double depth = (starts.empty() ? 0.0 : starts[device.loop().sensed]) - result.loop.controller.position;
  if (depth > 0.0) {
    const Units units = units_of(device.parameters().motion);
    remarks.push_back(note(fmt::format("the device starts {} inside the wall", quantity(depth, units.length)),
                           "the wall pushes it out"));
  }
}

bool never_moves(std::span<const double> sensed) {
  return std::ranges::all_of(sensed, [&](double each) { return each == sensed.front(); });
}

/// Friction that never lets go of the device.
void remark_stiction(std::vector<Remark>& remarks, const Simulation& result, const Device& device,
                     std::span<const double> sensed) {
  if (!never_moves(sensed) || whole_friction(device) == 0.0) return;
  const Units units = units_of(device.parameters().motion);
  std::string remedy = "push harder";
  if (result.loop.user_force.kind == UserForce::Kind::none && has_wall(result)) {
    const auto further = start_beyond_stiction(device, result.loop.controller);
    remedy = further ? fmt::format("start further out, {} from the wall's surface", quantity(*further, units.length))
                     : "a force limit above the friction";
  }
  remarks.push_back(warning(fmt::format("the device never moves: its friction of {} holds it where it starts",
                                        quantity(whole_friction(device), units.force)),
                            "the verdict says nothing about the wall", std::move(remedy)));
}

/// A wall that could not act, whatever its stiffness.
void remark_idle_wall(std::vector<Remark>& remarks, const Simulation& result, const Device& device,
                      std::span<const double> sensed) {
  if (!has_wall(result)) return;
  const Units units = units_of(device.parameters().motion);
  const double friction = whole_friction(device);
  const double limit = device.parameters().actuator.force_limit.value_or(std::numeric_limits<double>::infinity());
  if (friction >= limit && !never_moves(sensed) && result.loop.user_force.kind == UserForce::Kind::none) {
    remarks.push_back(
        warning(fmt::format("the actuator's {} are less than the friction of {}: no wall moves the device",
                            quantity(limit, units.force), quantity(friction, units.force)),
                "the verdict says nothing about the wall", "a force limit above the friction"));
  }
  const double step = device.parameters().sensor.resolution;
  const auto count = [&](double position) { return std::round((position - result.loop.controller.position) / step); };
  if (step > 0.0 && std::ranges::all_of(sensed, [&](double each) { return count(each) == count(sensed.front()); })) {
    remarks.push_back(warning(
        fmt::format("the encoder reads the same step of {} all the time", quantity(step, units.length)),
        "the wall's force never changes: the verdict says nothing about it", "start further out, or a finer encoder"));
  }
}

void remark_encoder(std::vector<Remark>& remarks, const Simulation& result, const Device& device) {
  if (!result.encoder_chatters) return;
  const Units units = units_of(device.parameters().motion);
  const ForceRipple& ripple = *result.force_ripple;
  const bool is_damped = result.loop.controller.damping > 0.0;
  remarks.push_back(warning(
      fmt::format("the encoder's steps of {} make the force ripple by {} either way, at {} on average",
                  quantity(device.parameters().sensor.resolution, units.length),
                  quantity(ripple.amplitude, units.force), quantity(hertz(ripple.frequency), "Hz")),
      result.verdict == LoopVerdict::drifts ? "it comes with slow motion, though nothing oscillates"
                                            : "the force changes though the device hardly moves",
      is_damped ? "a finer encoder, a low-pass on the wall's velocity, or less wall.damping" : "a finer encoder"));
}

void remark_run(std::vector<Remark>& remarks, const Simulation& result, const Device& device,
                const SimulationOptions& options) {
  const Units units = units_of(device.parameters().motion);
  const double simulated = static_cast<double>(result.samples) * device.loop().sampling_period;
  if (result.diverged && simulated < result.duration - device.loop().sampling_period) {
    remarks.push_back(note(fmt::format("the run ended after {}: the position passed {}", quantity(simulated, "s"),
                                       quantity(options.divergence, units.length)),
                           "the later motion is not simulated"));
  }
  const UserForce& force = result.loop.user_force;
  if (force.kind == UserForce::Kind::recorded) {
    const double length = force.period * static_cast<double>(force.samples.size() - 1);
    if (length > 0.5 * (result.duration - force.start)) {
      remarks.push_back(note("the recorded force acts in the part of the run that is judged",
                             "the verdict is about the device under that force"));
    }
  }
  if (result.verdict == LoopVerdict::undecided) {
    remarks.push_back(must_grow(result)
                          ? warning("nothing grows within this run, but by linear analysis something does",
                                    "a slowly growing oscillation may hide under others", "simulate for longer")
                          : warning("the run holds too few oscillations to tell", "", "simulate for longer"));
  }
  if (result.overloaded_steps > 0) {
    remarks.push_back(
        warning(fmt::format("{} steps had too many stick-slip instants to follow", result.overloaded_steps),
                "the motion is approximate there"));
  }
}

}  // namespace

void compare_with_linear(Simulation& result, const Device& device, std::span<const double> sensed) {
  result.nonlinear_parts = nonlinear_parts(result, device);
  const bool is_quiet = result.verdict == LoopVerdict::settles || result.verdict == LoopVerdict::forced;
  if (is_quiet && must_grow(result)) result.verdict = LoopVerdict::undecided;
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
  remark_run(remarks, result, device, options);
  remark_stiction(remarks, result, device, sensed);
  remark_idle_wall(remarks, result, device, sensed);
  remark_encoder(remarks, result, device);
  return remarks;
}

}  // namespace zwidth::internal
