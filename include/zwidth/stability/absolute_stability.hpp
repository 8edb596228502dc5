#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/stiffness_interval.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// The stiffest wall that is stable whoever holds the device.
struct AbsoluteStabilityLimit {
  /// The wall is stable with every passive user for every stiffness below; 0 where some user destabilises any wall,
  /// infinity where none destabilises one, NaN where it is not known (`trust` is refused). What `truncation` leaves open is
  /// taken off.
  double stiffness = 0.0;
  /// rad/s, where the worst user destabilises it; 0 where the limit is reached towards zero frequency, by ever heavier
  /// users (the limit of a rigid device is the same at all low frequencies, and counts as this), or is 0 or infinite
  double frequency = 0.0;
  /// Relative: the lowest K found is less than `stiffness (1 + truncation)` and so is the true limit; from the sums
  /// over aliases and from the bound on what lies between the frequencies looked at.
  double truncation = 0.0;
  /// The free device itself reaches it: no user makes the wall less stable than nobody.
  bool needs_no_user = false;
  /// absolute_stability_interval(), where analyze() was asked for it
  std::optional<StiffnessInterval> interval = {};
  /// doubtful where more than 1e-4 had to be taken off, and where frequencies at which nothing dissipates are not known
  Trust trust = {};

  /// What a wall may rest on: `stiffness`, and 0 where that is not known.
  [[nodiscard]] double lower_bound() const { return std::isnan(stiffness) ? 0.0 : stiffness; }
};

/// The limit over all passive users of a flexible device, with the virtual damper closed.
///
/// A passive user is any F_h = -Z(s) s x_h with Re Z >= 0. At one frequency the plant then runs over a disc of centre
/// G_sa - D and radius |D|,
///
///     D(jw) = jw G_sh G_ha / (2 Re Y),   Y = jw G_hh,   Re Y = w² q^H Dmp q
///     (q: positions per force at the held body, Dmp: damping matrix; no cancellation)
///
/// and the sampled plant over the sum of the discs of its aliases w + 2 pi k/T. The loop is stable with every passive
/// user iff it is stable with one and |1 + C c_T| > |C| r_T at all 0 < w <= pi/T.
/// The least K that violates this is found by a scan over frequency and then shown to be the least on whole intervals
/// that cover (0, pi/T], w -> 0 included, by bounds of interpolating polynomials (docs/absolute_stability.md says what is
/// proven). Frequencies at which the damped bodies stand still, above Nyquist too, are zeros of Re Y: found with a
/// hundred digits and seen however narrow. The tip of a mechanism is grasped in any direction: any_grasp_limit(), a scan.
/// Never above the critical stiffness of the free device. The device's [operator] is left out: it is one of
/// the users. Throws Error (needs_bodies) for a transfer function, and what critical_stiffness() throws. Source:
/// docs/theory.md, "What is added"; Colgate & Schenkel 1997 is the rigid case without delay.
[[nodiscard]] AbsoluteStabilityLimit absolute_stability_limit(const Device& device, VirtualDamper damper = {},
                                                              const Progress& progress = {});

/// The 95 % interval of absolute_stability_limit() over devices drawn from the uncertainty, as stiffness_interval() draws them: the
/// quantiles at 2.5 and 97.5 %, and the device's own limit. `other_mechanism`: the share of draws that have no limit where
/// the device has one, or the other way round. Requires an uncertainty and draws >= 1; throws Error (invalid_argument)
/// otherwise, and as absolute_stability_limit().
[[nodiscard]] StiffnessInterval absolute_stability_interval(const Device& device, VirtualDamper damper = {},
                                                            std::size_t draws = 200,
                                                            std::uint64_t seed = usual_draws_seed,
                                                            const Progress& progress = {});

}  // namespace zwidth
