#pragma once

#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/stiffness_interval.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {

/// The device with every link rigid: one mass, damper and spring (operator included).
struct RigidApproximation {
  double mass = 0.0;
  double damping = 0.0;
  double stiffness = 0.0;      ///< to ground
  CriticalStiffness critical;  ///< of the same loop: period, delay, lag, virtual damper
};

/// Eq. 24 of Díaz & Gil: Q = m_m z_n w_n, the stiffness that the resonance peak of a two-body device sits at.
///
/// The mode matters when Q is similar to or *smaller* than the rigid critical stiffness (the paper prints "larger": see
/// theory, section 3.3). Q is about the least stiffness of the resonance branch over all delays. An approximation.
struct QCriterion {
  double stiffness = 0.0;  ///< Q
  /// Q <= rigid critical stiffness; absent unless the actuated body is sensed, that stiffness is finite and the
  /// wall has no damper.
  std::optional<bool> mode_matters;
};

/// The whole answer for one device.
struct Analysis {
  CriticalStiffness critical;
  std::vector<Mode> modes;                    ///< vibration modes, by rising frequency
  std::optional<Mode> suspended_rigid_body;   ///< where springs tie the device to ground
  std::optional<RigidApproximation> rigid;    ///< absent for a transfer function
  std::optional<QCriterion> q_criterion;      ///< only where as_two_mass() applies, no wall filters
  std::optional<WallMargins> wall;            ///< absent without wall.stiffness
  std::optional<StiffnessInterval> interval;  ///< of the critical stiffness; absent without an uncertainty
};

/// Analyses a device: critical stiffness (with the wall's damper closed), modes, rigid approximation, Q, margins.
/// Throws Error (did_not_converge) as its parts do.
[[nodiscard]] Analysis analyze(const Device& device);

}  // namespace zwidth
