#include "zwidth/model/two_mass.hpp"

#include <cmath>

namespace zwidth {

TwoMassFactors two_mass_factors(const TwoMass& device) {
  const double mass = device.motor_mass + device.body_mass;
  const double damping = device.motor_damping + device.body_damping;
  TwoMassFactors f{};
  f.omega_1 = std::sqrt(device.cable_stiffness / device.motor_mass);                              // eq. 11
  f.omega_2 = std::sqrt(device.cable_stiffness / device.body_mass);                               // eq. 12
  f.omega_n = std::sqrt(device.cable_stiffness * mass / (device.body_mass * device.motor_mass));  // eq. 13
  f.z_1 = (device.motor_damping + device.cable_damping) / device.motor_mass;                      // eq. 14
  f.z_2 = (device.body_damping + device.cable_damping) / device.body_mass;                        // eq. 15
  f.z_n = f.z_1 + f.z_2 - damping / mass;                                                         // eq. 16
  const double mismatch = (device.motor_damping * device.body_mass - device.body_damping * device.motor_mass) / mass;
  // s² coefficient of eqs. 5-7's denominator: k_c m + b_m b_d + b_c b
  const double exact =
      device.cable_stiffness * mass + device.motor_damping * device.body_damping + device.cable_damping * damping;
  f.relative_error = mismatch * mismatch / exact;
  return f;
}

std::optional<TwoMass> as_two_mass(const Device& device) {
  const User& user = device.parameters().user;
  if (device.bodies().size() != 2 || device.links().size() != 1 || user.stiffness > 0.0) return std::nullopt;
  for (const Body& body : device.bodies())
    if (body.stiffness > 0.0) return std::nullopt;
  const std::size_t actuated = device.loop().actuated;
  const std::size_t other = 1 - actuated;
  TwoMass two{device.bodies()[actuated].mass, device.bodies()[other].mass, device.bodies()[actuated].damping,
              device.bodies()[other].damping, device.links()[0].stiffness, device.links()[0].damping};
  if (!(two.cable_stiffness > 0.0)) return std::nullopt;
  const bool holds_motor = device.loop().held == actuated;
  (holds_motor ? two.motor_mass : two.body_mass) += user.mass;
  (holds_motor ? two.motor_damping : two.body_damping) += user.damping;
  return two;
}

}  // namespace zwidth
