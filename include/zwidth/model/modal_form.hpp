#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth {

/// One real term of a partial-fraction expansion, degree(numerator) < degree(denominator) <= max_degree.
///
///     (n[0] + n[1] s + ...) / (d[0] + d[1] s + ... + s^degree)
///
/// Degree 1: a lone real pole; 2: a mode (or the rigid body, d[0] = 0 when nothing ties it to ground); more: poles so
/// close together that separate terms would cancel.
struct ModalTerm {
  static constexpr std::size_t max_degree = 24;  ///< of a cluster of poles
  std::size_t degree = 0;                        ///< how many poles it has
  double numerator[max_degree] = {};             ///< by rising powers, `degree` of them
  double denominator[max_degree] = {};           ///< monic; the leading 1 is not stored
  /// What rounding to double left out of each coefficient, for sums of terms that nearly cancel
  double numerator_rest[max_degree] = {};
  double denominator_rest[max_degree] = {};  ///< by rising powers, without the leading 1
  /// 0: rigid body; i > 0: vibration mode i, by rising frequency; -1: actuator lag; -2: the drive's tracking
  int mode = 0;
  /// The part of the lag term's numerator that stems from this mode: lag_numerator / (s + 1/tau)
  double lag_numerator = 0.0;
  /// The part of the tracking's numerator that stems from this mode, over (s + w)²; by rising powers
  double tracking_numerator[2] = {};
  int integrators = 0;              ///< poles at s = 0
  int unstable_poles = 0;           ///< poles with positive real part (of a transfer function)
  int undamped_pairs = 0;           ///< pole pairs on the imaginary axis, s != 0
  double undamped_frequency = 0.0;  ///< their frequency, rad/s
};

/// A vibration mode: the pole pair s² + 2 zeta w s + w².
struct Mode {
  double frequency = 0.0;      ///< w, undamped natural frequency, rad/s
  double damping_ratio = 0.0;  ///< zeta; above 1 for two real poles
};

/// The response from a force to a position as a sum of modal terms, one for the rigid body and one per mode.
///
///     G(s) = sum_k N_k(s) / D_k(s)
///
/// Unlike one transfer function of high degree it keeps full relative accuracy at every frequency, with stiff links,
/// light or critical damping and widely spread masses. Poles are found by Ehrlich-Aberth iteration on
/// det(M s² + D s + K) in double-double arithmetic; poles closer than cluster_tolerance share a term. Where that does
/// not carry (many poles close together) they are isolated with proof from the exact polynomial, and terms that cancel
/// are joined.
struct ModalForm {
  std::vector<ModalTerm> terms;  ///< rigid body first, then modes by rising frequency, lag and tracking last
  std::vector<Mode> modes;       ///< vibration modes only, by rising frequency
  std::optional<Mode> suspended_rigid_body;  ///< the rigid-body motion where springs tie it to ground
};

/// From which body's force to which body's position.
struct Path {
  std::size_t force_at = 0;     ///< the body that is pushed
  std::size_t position_of = 0;  ///< the body that is seen
};

/// Whether the actuator's lag and the drive's tracking of the position are part of a model.
enum class ActuatorLag { included, left_out };

/// Modal form of the device from actuated to sensed body (user, actuator lag and tracking included).
///
/// Throws Error (did_not_converge) when the poles cannot be found to the documented accuracy.
/// Source: docs/theory.md, "Critical stiffness"; eqs. 5-9 of Díaz & Gil are the two-body case.
[[nodiscard]] ModalForm modal_form(const Device& device);

/// The same for any pair of bodies, for instance held -> held for the paper's G_d.
/// Throws Error (needs_bodies) for a transfer-function device.
[[nodiscard]] ModalForm modal_form(const Device& device, Path path, ActuatorLag lag);

/// G(jw) of the sum of terms; w in rad/s, w > 0.
[[nodiscard]] std::complex<double> response(const ModalForm& form, double frequency);

/// G(jw) of one term.
[[nodiscard]] std::complex<double> response(const ModalTerm& term, double frequency);

}  // namespace zwidth
