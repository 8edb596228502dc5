#pragma once

#include <optional>

#include "zwidth/model/device.hpp"

namespace zwidth {

/// The paper's parameters of a device of two bodies and one link: motor (subscript m) and body (subscript d).
struct TwoMass {
  double motor_mass = 0.0;       ///< m_m
  double body_mass = 0.0;        ///< m_d
  double motor_damping = 0.0;    ///< b_m
  double body_damping = 0.0;     ///< b_d
  double cable_stiffness = 0.0;  ///< k_c
  double cable_damping = 0.0;    ///< b_c
};

/// Natural frequency and coefficients of the factorised form, eqs. 11-16.
struct TwoMassFactors {
  double omega_1;  ///< rad/s
  double omega_2;  ///< rad/s
  double omega_n;  ///< rad/s
  double z_1;      ///< 1/s
  double z_2;      ///< 1/s
  double z_n;      ///< 1/s
  /// Error of the denominator's s² coefficient relative to the exact one (docs/theory.md, "The paper's errata").
  double relative_error;
};
[[nodiscard]] TwoMassFactors two_mass_factors(const TwoMass& device);  ///< eqs. 11-16

/// The two-mass view of a device: two bodies, one link, no ground springs (the user's mass and damping are
/// added to the held body). Nothing where the device is of another shape.
[[nodiscard]] std::optional<TwoMass> as_two_mass(const Device& device);

}  // namespace zwidth
