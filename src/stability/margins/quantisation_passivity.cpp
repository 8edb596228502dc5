#include "zwidth/stability/quantisation_passivity.hpp"

#include <algorithm>

namespace zwidth {

std::optional<QuantisationPassivity> quantisation_passivity(const Device& device) {
  const DeviceParameters& parameters = device.parameters();
  double friction = 0.0;
  double damping = 0.0;
  for (const Body& body : device.bodies()) {
    friction += body.coulomb;
    damping += body.damping;
  }
  const double resolution = parameters.sensor.resolution;
  if (!(friction > 0.0) || !(resolution > 0.0)) return std::nullopt;
  QuantisationPassivity bound;
  bound.friction_stiffness = 2.0 * friction / resolution;
  bound.damping_stiffness = 2.0 * damping / parameters.loop.sampling_period;
  bound.stiffness = std::min(bound.friction_stiffness, bound.damping_stiffness);
  if (!parameters.links.empty()) bound.not_met.push_back(UnmetAssumption::flexible_links);
  if (std::ranges::any_of(device.bodies(), [](const Body& body) { return body.stiffness > 0.0; })) {
    bound.not_met.push_back(UnmetAssumption::springs_to_ground);
  }
  if (parameters.loop.delay > 0.0) bound.not_met.push_back(UnmetAssumption::delay);
  if (parameters.actuator.time_constant > 0.0) bound.not_met.push_back(UnmetAssumption::actuator_lag);
  if (parameters.sensor.tracking_bandwidth > 0.0) bound.not_met.push_back(UnmetAssumption::tracking);
  if (parameters.wall.damping > 0.0) bound.not_met.push_back(UnmetAssumption::virtual_damper);
  if (!parameters.wall.filters.empty()) bound.not_met.push_back(UnmetAssumption::wall_filters);
  return bound;
}

}  // namespace zwidth
