#pragma once

// The responses of two bodies in closed form, as the paper prints them: a second route beside the modal form.

#include <complex>

#include "zwidth/model/two_mass.hpp"

namespace zwidth::test {

/// The three responses of eq. 3.
struct TwoMassResponse {
  std::complex<double> G_d;  ///< body force -> body position
  std::complex<double> G_c;  ///< either force -> the other position
  std::complex<double> G_m;  ///< motor force -> motor position
};

/// Closed forms, eqs. 5-9 of Díaz & Gil, at any complex s that is not a pole.
inline TwoMassResponse two_mass_response(const TwoMass& device, std::complex<double> s) {
  const std::complex<double> cable = device.cable_stiffness + device.cable_damping * s;
  const std::complex<double> motor = device.motor_mass * s * s + device.motor_damping * s;
  const std::complex<double> body = device.body_mass * s * s + device.body_damping * s;
  const std::complex<double> p_m = motor + cable;                                     // eq. 9
  const std::complex<double> p_d = body + cable;                                      // eq. 8
  const std::complex<double> characteristic = motor * body + (motor + body) * cable;  // p_d p_m - (k_c + b_c s)²
  return {p_m / characteristic, cable / characteristic, p_d / characteristic};        // eqs. 5-7
}

/// Rigid body times vibration mode, eqs. 10-16 of Díaz & Gil. An approximation: the s² coefficient of the
/// denominator is off by [(b_m m_d - b_d m_m)/m]²; exact iff b_m/m_m = b_d/m_d.
inline TwoMassResponse two_mass_factorised_response(const TwoMass& device, std::complex<double> s) {
  const TwoMassFactors f = two_mass_factors(device);
  const double mass = device.motor_mass + device.body_mass;
  const double damping = device.motor_damping + device.body_damping;
  const double w_n2 = f.omega_n * f.omega_n;
  // eq. 10: rigid body times mode
  const std::complex<double> common = w_n2 / ((mass * s * s + damping * s) * (s * s + f.z_n * s + w_n2));
  const auto lead = [s](double z, double w) { return (s * s + z * s + w * w) / (w * w); };
  return {common * lead(f.z_1, f.omega_1), common * (1.0 + device.cable_damping / device.cable_stiffness * s),
          common * lead(f.z_2, f.omega_2)};
}

}  // namespace zwidth::test
