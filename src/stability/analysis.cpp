#include "zwidth/stability/analysis.hpp"

#include <algorithm>

#include "zwidth/model/two_mass.hpp"

namespace zwidth {
namespace {

VirtualDamper damper_of(const Device& device) {
  return {device.parameters().wall.damping, device.parameters().wall.velocity_filter_hz};
}

RigidApproximation rigid_approximation(const Device& device, const CriticalStiffness& of_device) {
  const Operator& user = device.parameters().user;
  RigidApproximation rigid{user.mass, user.damping, user.stiffness, {}};
  for (const Body& body : device.bodies()) {
    rigid.mass += body.mass;
    rigid.damping += body.damping;
    rigid.stiffness += body.stiffness;
  }
  if (device.bodies().size() == 1) {
    rigid.critical = of_device;
    return rigid;
  }
  DeviceParameters parameters;
  parameters.name = "rigid";
  parameters.bodies.push_back({"body", rigid.mass, rigid.damping, rigid.stiffness, 0.0});
  parameters.loop.sampling_period = device.loop().sampling_period;
  parameters.loop.delay = device.loop().delay;
  parameters.actuator = device.parameters().actuator;
  parameters.wall.filters = device.parameters().wall.filters;
  rigid.critical = critical_stiffness(filtered_plant(Device(std::move(parameters))), damper_of(device));
  return rigid;
}

std::optional<QCriterion> q_criterion(const Device& device, const RigidApproximation& rigid) {
  const std::optional<TwoMass> two = as_two_mass(device);
  const Wall& wall = device.parameters().wall;
  if (!two || !wall.filters.empty()) return std::nullopt;
  const TwoMassFactors factors = two_mass_factors(*two);
  QCriterion criterion{two->motor_mass * factors.z_n * factors.omega_n, std::nullopt};  // eq. 24
  if (wall.damping == 0.0 && device.loop().sensed == device.loop().actuated &&
      rigid.critical.status == StiffnessStatus::finite) {
    criterion.mode_matters = criterion.stiffness <= rigid.critical.stiffness;
  }
  return criterion;
}

}  // namespace

Analysis analyze(const Device& device) {
  ModalForm form = modal_form(device);
  const SampledPlant plant = filtered_plant(sample(form, {device.loop().sampling_period, device.loop().delay}),
                                            device.parameters().wall.filters);
  Analysis analysis;
  analysis.critical = critical_stiffness(plant, damper_of(device));
  analysis.modes = std::move(form.modes);
  analysis.suspended_rigid_body = form.suspended_rigid_body;
  if (device.has_bodies()) {
    analysis.rigid = rigid_approximation(device, analysis.critical);
    analysis.q_criterion = q_criterion(device, *analysis.rigid);
  }
  if (device.parameters().wall.stiffness) analysis.wall = wall_margins(device);
  if (device.parameters().uncertainty) analysis.interval = stiffness_interval(device);
  return analysis;
}

}  // namespace zwidth
