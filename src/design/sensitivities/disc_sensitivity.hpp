#pragma once

#include <complex>
#include <span>
#include <vector>

#include "design/sensitivities/design_parameter.hpp"
#include "stability/users/termination_discs.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// The disc of passive users at one angle, with the wall's filters, and its derivatives at a fixed angle.
struct DiscSensitivity {
  TerminationDiscs::Disc disc;
  std::vector<std::complex<double>> centre_by_parameter;
  std::vector<double> radius_by_parameter;
};

/// Differentiates the sums over aliases term by term, by the nodes of the discs' own rule: with Z = K - w² M + jw D,
/// q = Z^-1 e_held and Q = q^H D q, a term is g = q_s q_a/((1 + j tau w) 2 w² Q) and
///
///     dq = -Z^-1 dZ q,    dQ = q^H dD q - 2 Re[(Z^-1 D conj q)^T dZ q]
///
/// The period follows from the others: a change of the unit of time changes no stiffness,
///
///     T c_T + t_d c_td + tau c_tau + sum (2 m c_m + b c_b) = 0.
///
/// `free` is the device without its user, `discs` are its discs; 0 < angle <= pi.
[[nodiscard]] DiscSensitivity disc_sensitivity(const Device& free, const TerminationDiscs& discs, double angle,
                                               std::span<const DesignParameter> parameters);

}  // namespace zwidth::internal
