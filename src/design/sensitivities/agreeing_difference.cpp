#include "design/sensitivities/agreeing_difference.hpp"

#include <algorithm>

#include "zwidth/model/damper_timing.hpp"

namespace zwidth::internal {
namespace {

using Kind = DesignParameter::Kind;

constexpr double whole_sample = 1e-9;
constexpr double unit_of_pose = 1.0;  // rad; of a slide m, where a step is a millimetre

double fast_period_of(const Loop& loop) { return std::min(loop.sampling_period, damper_timing(loop).sampling_period); }

bool is_whole_delay(double delay, double period) {
  return delay > 0.0 && std::abs(std::remainder(delay, period)) < whole_sample * period;
}

bool only_growing_tells(const DesignParameter& number, const Loop& loop) {
  if (number.kind == Kind::joint_position) return false;
  if (number.value == 0.0) return true;
  const double period = fast_period_of(loop);
  if (number.kind == Kind::delay) return is_whole_delay(number.value, period);
  return number.kind == Kind::sampling_period &&
         (is_whole_delay(loop.delay, period) || is_whole_delay(damper_timing(loop).delay, period));
}

// How far the tip moves per unit of the coordinate that moves it most; a cable's numbers are at a joint.
double lever_of(const DeviceParameters& parameters) {
  double lever = 0.0;
  if (!parameters.coordinates) return 1.0;
  for (const double weight : parameters.coordinates->points[parameters.loop.held].weights) {
    lever = std::max(lever, std::abs(weight));
  }
  return lever;
}

}  // namespace

DifferenceStep difference_step(const DesignParameter& number, const DeviceParameters& parameters, double stiffness,
                               double frequency) {
  const double period = fast_period_of(parameters.loop);
  DifferenceStep step{number.value, only_growing_tells(number, parameters.loop)};
  if (number.kind == Kind::joint_position) step.unit = unit_of_pose;
  if (number.kind == Kind::delay && number.value > 0.0 && !is_whole_delay(number.value, period)) {
    const double part = std::abs(std::remainder(number.value, period));
    step.unit = std::min(number.value, part / (2.0 * widest_difference));
  }
  if (step.unit != 0.0) return step;
  switch (number.kind) {
    case Kind::body_mass:
    case Kind::user_mass: {
      for (const Body& body : parameters.bodies) step.unit += body.mass;
      const double at = frequency > 0.0 ? frequency : 1.0 / period;
      if (parameters.bodies.empty()) step.unit = stiffness / (at * at);
      return step;
    }
    case Kind::body_stiffness:
    case Kind::link_stiffness:
    case Kind::user_stiffness:
      step.unit = stiffness;
      return step;
    case Kind::body_damping:
    case Kind::link_damping:
    case Kind::user_damping:
    case Kind::wall_damping:
      step.unit = stiffness * parameters.loop.sampling_period;
      return step;
    case Kind::mechanism_inertia: {
      const double at = frequency > 0.0 ? frequency : 1.0 / period;
      step.unit = stiffness / (at * at) * lever_of(parameters) * lever_of(parameters);
      return step;
    }
    case Kind::transmission:
    case Kind::mechanism_damping:
      step.unit = stiffness * parameters.loop.sampling_period * lever_of(parameters) * lever_of(parameters);
      return step;
    default:
      step.unit = period;
      return step;
  }
}

}  // namespace zwidth::internal
