#pragma once

#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/stability/unmet_assumption.hpp"

namespace zwidth {

/// Up to where the device's own friction dissipates what a sampled, quantised spring generates.
///
///     K <= min(2 b / T, 2 f_c / q)
///
/// b and f_c: damping and Coulomb friction of all bodies, q the encoder's step. Sufficient for passivity, with any
/// passive user; about the encoder's steps, which the linear limits leave out. Below it they cannot feed an
/// oscillation; above it they may (it need not be unstable: the linear limits decide on growth).
/// Valid for one rigid body, a spring alone, a hold without further delay. Source: Abbott & Okamura 2005.
struct QuantisationPassivity {
  double friction_stiffness = 0.0;            ///< 2 f_c / q
  double damping_stiffness = 0.0;             ///< 2 b / T
  double stiffness = 0.0;                     ///< the lesser
  std::vector<UnmetAssumption> not_met = {};  ///< what the formula leaves out and the device has; empty where it holds
};

/// That bound; absent without bodies, Coulomb friction or an encoder resolution.
[[nodiscard]] std::optional<QuantisationPassivity> quantisation_passivity(const Device& device);

}  // namespace zwidth
