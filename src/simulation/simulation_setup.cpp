#include "simulation/simulation_setup.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "counted.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/stability/holder_limit.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
namespace internal {
namespace {

constexpr double default_offset = 1e-3;   // m or rad, of a device that nothing else moves
constexpr double least_duration = 1.0;    // s
constexpr double default_periods = 40.0;  // of the critical oscillation
constexpr double default_delays = 4.0;
constexpr double default_samples = 1e6;   // at most
constexpr double beyond_stiction = 10.0;  // times the friction: some swings are left until it rests
constexpr double never = std::numeric_limits<double>::infinity();

ControllerOptions controller_of(const Device& device, const SimulationOptions& options) {
  ControllerOptions controller;
  if (options.controller) {
    controller = *options.controller;
  } else {
    const Wall& wall = device.parameters().wall;
    controller = wall_controller(wall);
    if (!wall.stiffness && wall.damping == 0.0) controller.kind = ControllerOptions::Kind::none;
  }
  controller.position = options.wall_position.value_or(controller.position);
  controller.contact = options.contact.value_or(controller.contact);
  return controller;
}

/// Springs to ground, the user's included, N/m or N m/rad.
double ground_stiffness(const Device& device) {
  double sum = device.parameters().user.stiffness;
  for (const Body& body : device.bodies()) sum += body.stiffness;
  return sum;
}

double measured(const Device& device, double position) {
  const double step = device.parameters().sensor.resolution;
  return step > 0.0 ? step * std::floor(position / step + 0.5) : position;
}

/// What pulls a device back that starts so far inside the wall, N or N m.
double pull_at(const Device& device, const ControllerOptions& wall, double offset) {
  const double limit = device.parameters().actuator.force_limit.value_or(never);
  const double depth = measured(device, wall.position + offset) - wall.position;
  return std::min(wall.stiffness * std::abs(depth), limit) + ground_stiffness(device) * offset;
}

bool is_zero(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return value == 0.0; });
}

bool asks_for_a_start(const SimulationOptions& options) {
  return options.initial_position.empty() && options.initial_velocity.empty() &&
         options.user_force.kind == UserForce::Kind::none;
}

/// What the options leave open, but for where the device starts.
HybridLoopOptions loop_of(const Device& device, const SimulationOptions& options) {
  HybridLoopOptions loop;
  loop.controller = controller_of(device, options);
  loop.user_force = options.user_force;
  loop.faults = options.faults;
  loop.initial_position = options.initial_position;
  loop.initial_velocity = options.initial_velocity;
  return loop;
}

void start_inside_the_wall(SimulationSetup& setup, const Device& device) {
  ControllerOptions& wall = setup.loop.controller;
  if (wall.kind == ControllerOptions::Kind::relay) return;
  if (!device.has_bodies()) {
    if (wall.position == 0.0) wall.position = -default_offset;
    return;
  }
  double offset = default_offset;
  const double friction = whole_friction(device);
  const double pull = pull_at(device, wall, offset);
  const auto further = start_beyond_stiction(device, wall);
  if (pull <= friction && further && *further > offset) {
    const Units units = units_of(device.parameters().motion);
    offset = *further;
    Finding finding{.code = FindingCode::start_unseen_by_encoder,
                    .evidence = {{"usual_start", default_offset, units.length}, {"start", offset, units.length}}};
    if (friction > 0.0) {
      finding.code = FindingCode::start_inside_stiction;
      finding.evidence.push_back({"wall_force", pull, units.force});
      finding.evidence.push_back({"friction", friction, units.force});
    }
    setup.moved_start = note(std::move(finding));
  }
  setup.loop.initial_position.assign(device.bodies().size(), wall.position + offset);
}

/// Where no duration is given, of the longest by default.
std::optional<OptionProblem> kept_points_problem(const SimulationOptions& options, const Device& device) {
  if (options.keep_at_most) {
    if (*options.keep_at_most > 0) return std::nullopt;
    return option_problem("keep_at_most", {.code = ProblemCode::no_points_kept});
  }
  if (options.keep_every == 0) return std::nullopt;
  const double period = device.loop().sampling_period;
  const double samples = options.duration.value_or(default_samples * period + options.user_force.start) / period;
  const double points = samples / static_cast<double>(options.keep_every);
  if (points <= max_kept_points) return std::nullopt;
  return option_problem("keep_every", {.code = ProblemCode::too_many_points_kept,
                                       .evidence = {counted("value", options.keep_every),
                                                    {"points", points},
                                                    {"least", std::ceil(samples / max_kept_points)},
                                                    {"most", max_kept_points}}});
}

std::optional<OptionProblem> duration_problem(const SimulationOptions& options, const Device& device) {
  const Loop& loop = device.loop();
  const double period = loop.sampling_period;
  if (!options.duration) {
    const double latest = (max_simulated_samples - default_samples) * period;
    if (options.user_force.start <= latest) return std::nullopt;
    return option_problem("user_force.start", {.code = ProblemCode::too_long,
                                               .evidence = {{"value", options.user_force.start}, {"most", latest}}});
  }
  const double duration = *options.duration;
  const auto problem = [duration](ProblemCode code, std::vector<Evidence> evidence) {
    evidence.push_back({"value", duration});
    return option_problem("duration", {.code = code, .evidence = std::move(evidence)});
  };
  const double samples = std::round(duration / period);
  if (!(samples >= 1.0 && samples <= max_simulated_samples)) {
    return problem(ProblemCode::duration_out_of_range,
                   {{"least", period}, {"most", max_simulated_samples * period}, {"samples", max_simulated_samples}});
  }
  if (loop.delay >= duration) {
    return problem(ProblemCode::no_force_would_arrive, {{"delay", loop.delay}});
  }
  if (options.user_force.kind != UserForce::Kind::none && options.user_force.start >= duration) {
    return problem(ProblemCode::over_before_user_force, {{"start", options.user_force.start}});
  }
  return std::nullopt;
}

/// Whether anything sets the device in motion.
std::optional<OptionProblem> start_problem(const SimulationOptions& options, const Device& device) {
  const ControllerOptions wall = controller_of(device, options);
  if (wall.kind == ControllerOptions::Kind::relay) return std::nullopt;
  const bool only_pushes = wall.contact == ControllerOptions::Contact::unilateral;
  if (asks_for_a_start(options)) {
    if (wall.kind == ControllerOptions::Kind::none || wall.stiffness == 0.0) {
      return option_problem("", {.code = ProblemCode::nothing_moves});
    }
    if (only_pushes) {
      return option_problem("contact", {.code = ProblemCode::nothing_presses});
    }
    if (device.has_bodies() || !options.wall_position) return std::nullopt;
  }
  const bool is_pushed =
      wall.kind == ControllerOptions::Kind::wall && wall.position != 0.0 && (!only_pushes || wall.position < 0.0);
  if (is_pushed || options.user_force.kind != UserForce::Kind::none || !is_zero(options.initial_position) ||
      !is_zero(options.initial_velocity)) {
    return std::nullopt;
  }
  if (!device.has_bodies()) {
    return option_problem("wall_position", {.code = ProblemCode::wall_where_nothing_moves});
  }
  const char* const start = options.initial_position.empty() ? "initial_velocity" : "initial_position";
  return option_problem(start, {.code = ProblemCode::starts_where_nothing_moves});
}

/// The device with the controller's wall.
Device with_wall_of(const Device& device, const ControllerOptions& controller) {
  DeviceParameters parameters = device.parameters();
  parameters.wall = {};
  if (controller.kind == ControllerOptions::Kind::wall) {
    parameters.wall = {controller.stiffness, controller.damping, controller.velocity_filter_hz, controller.filters};
  }
  return Device(std::move(parameters));
}

}  // namespace

double whole_friction(const Device& device) {
  double sum = 0.0;
  for (const Body& body : device.bodies()) sum += body.coulomb;
  return sum;
}

std::optional<double> start_beyond_stiction(const Device& device, const ControllerOptions& wall) {
  const double friction = whole_friction(device);
  const double ground = ground_stiffness(device);
  const double limit = device.parameters().actuator.force_limit.value_or(never);
  if (limit <= friction && ground == 0.0) return std::nullopt;
  const double stiffness = (wall.kind == ControllerOptions::Kind::wall ? wall.stiffness : 0.0) + ground;
  if (stiffness == 0.0) return std::nullopt;
  return std::max(beyond_stiction * friction / stiffness, beyond_stiction * device.parameters().sensor.resolution);
}

SimulationSetup simulation_setup(const Device& device, const SimulationOptions& options) {
  SimulationSetup setup{loop_of(device, options), std::nullopt};
  if (asks_for_a_start(options)) start_inside_the_wall(setup, device);
  return setup;
}

LinearAnswer linear_answer(const Device& device, const SimulationOptions& options) {
  const Device linear = options.controller ? with_wall_of(device, *options.controller) : device;
  const Wall& wall = linear.parameters().wall;
  LinearAnswer answer;
  answer.critical = critical_stiffness(linear);
  const bool is_held = device_has_user(linear);
  const Device alone = is_held ? device_without_user(linear) : linear;
  const CriticalStiffness of_alone = is_held ? critical_stiffness(alone) : answer.critical;
  answer.limits.nobody = limit_of_holder(of_alone);
  if (is_held) answer.limits.user = limit_of_holder(answer.critical);
  if (!wall.stiffness || answer.critical.trust.refused()) return answer;
  const WallMargins margins = wall_margins(linear);
  answer.wall_stable = margins.stable;
  if (!of_alone.trust.refused()) {
    answer.stable_for = StableFor{.nobody = is_held ? wall_margins(alone).stable : margins.stable};
    if (is_held) answer.stable_for->user = margins.stable;
  }
  answer.spectral_radius = margins.spectral_radius;
  if (answer.critical.status == StiffnessStatus::finite) {
    answer.wall_share = *wall.stiffness / answer.critical.stiffness;
  }
  return answer;
}

double default_duration(const Device& device, const CriticalStiffness& critical, const UserForce& force) {
  const Loop& loop = device.loop();
  double duration = std::max(least_duration, default_delays * std::max(loop.delay, damper_timing(loop).delay));
  if (critical.limit && critical.limit->frequency > 0.0) {
    duration = std::max(duration, default_periods * 2.0 * std::numbers::pi / critical.limit->frequency);
  }
  return std::min(duration, default_samples * loop.sampling_period) + force.start;
}

}  // namespace internal

std::optional<OptionProblem> find_problem(const SimulationOptions& options, const Device& device) {
  using namespace internal;
  HybridLoopOptions loop = loop_of(device, options);
  if (auto problem = find_problem(loop, device)) {
    if (problem->member == "controller.position" && options.wall_position) problem->member = "wall_position";
    return problem;
  }
  if (auto problem = duration_problem(options, device)) return problem;
  if (auto problem = kept_points_problem(options, device)) return problem;
  if (!(std::isfinite(options.divergence) && options.divergence > 0.0)) {
    return option_problem("divergence", {.code = ProblemCode::not_above_zero_or_infinite,
                                         .evidence = {{"value", options.divergence}},
                                         .subjects = {{"in", "m or rad"}}});
  }
  return start_problem(options, device);
}

}  // namespace zwidth
