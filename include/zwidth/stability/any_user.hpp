#pragma once

#include "zwidth/model/device.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {

/// The stiffest wall that is stable whoever holds the device.
struct AnyUserLimit {
  /// The wall is stable with every passive user for every stiffness below; 0 where some user destabilises any wall,
  /// infinity where none destabilises one.
  double stiffness = 0.0;
  /// rad/s in (0, pi/T], where the worst user destabilises it; 0 where the limit is 0 or infinite
  double frequency = 0.0;
  /// Relative error that the truncated sums over aliases may leave in `stiffness`.
  double truncation = 0.0;
  /// The free device itself reaches it: no user makes the wall less stable than nobody.
  bool needs_no_user = false;
};

/// The limit over all passive users of a flexible device, exactly, with the virtual damper closed.
///
/// A passive user is any F_h = -Z(s) s x_h with Re Z >= 0. At one frequency the plant then runs over a disc of centre
/// G_sa - D and radius |D|,
///
///     D(jw) = jw G_sh G_ha / (2 Re Y),   Y = jw G_hh,   Re Y = w² q^H Dmp q
///
/// (q: positions per force at the held body; Dmp: damping matrix; nothing cancels),
///
/// and the sampled plant over the sum of the discs of its aliases w + 2 pi k/T. The loop is stable with every passive
/// user iff it is stable with one and |1 + C c_T| > |C| r_T at all 0 < w <= pi/T. The least K that violates it at one
/// frequency is the root of a quadratic; it is minimised over frequency from samples (evenly, the more the longer the
/// delay; down to 1e-7 rad per sample; around every mode and its aliases) and refined: a scan, not a proof of
/// completeness, unlike critical_stiffness(). Never above the critical stiffness of the free device, which is that.
/// The device's [operator] is left out: it is one of the users.
/// The sums over aliases are taken one by one at first and by quadrature beyond. Towards w = 0, where the discs grow
/// without bound, |c_T|² - r_T² is taken from a formula in which nothing large cancels.
/// Throws Error (needs_bodies) for a transfer function, and what critical_stiffness() throws.
/// Source: theory, section 5; Colgate & Schenkel 1997 is the rigid case without delay.
[[nodiscard]] AnyUserLimit any_user_limit(const Device& device, VirtualDamper damper = {});

}  // namespace zwidth
