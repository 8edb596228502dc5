#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth {

/// A lossless user at the held body: a mass, a spring to ground, and bodies hung on springs.
///
///     Z(s) = m s + k/s + sum of 1/(s/k_i + 1/(m_i s))      (Foster's first form of an impedance)
struct UserNetwork {
  /// A body on a spring, hung on the held body.
  struct Absorber {
    double mass = 0.0;       ///< m_i > 0
    double stiffness = 0.0;  ///< k_i > 0
  };
  double mass = 0.0;                ///< m
  double stiffness = 0.0;           ///< k, to ground
  std::vector<Absorber> absorbers;  ///< by rising frequency of the alias that each serves
};

/// The device held by that user in place of its own [operator]: one further body and link per absorber.
/// Throws Error (needs_bodies) for a transfer function, and as Device does where the user has impossible values.
[[nodiscard]] Device held_by(const Device& device, const UserNetwork& user);

/// A passive user that (nearly) reaches the absolute stability limit.
struct WorstUser {
  UserNetwork user;  ///< with whom the limit for any user is reached
  /// With this wall a pole of the device held by this user lies on the unit circle, at `frequency`: its K_CR is no
  /// more.
  double critical_stiffness = 0.0;
  double frequency = 0.0;  ///< rad/s
};

/// For aliases; where the mass at the held body is hung on a spring as well, that is one more.
inline constexpr std::size_t most_absorbers = 12;

/// The user that proves an absolute stability limit tight: with it, the wall is unstable hardly above the limit.
///
/// At the limit's frequency w the worst plant lies on the boundary of its disc, which takes the right reactance at w
/// and at the aliases |w + 2 pi k/T|: there each alias' own disc must point the same way. The mass or spring gives the
/// reactance at w, one absorber tuned beside each alias that matters gives it there. As few are taken as bring
/// `critical_stiffness` within 5e-5 of the limit; a user with absorbers is returned only where the closed-loop
/// eigenvalues are unstable at 1.0001 times its `critical_stiffness`.
/// Where the aliases' radii fall slowly (one body actuated, sensed and held, the delay no whole number of samples: as
/// 1/k²) most_absorbers leave some per mille, up to 3 % of the limit. A limit reached as w goes to 0 is represented by
/// a user for a low frequency. With more than two absorbers critical_stiffness() of the held device is not to be relied
/// on: their resonances share one sampled frequency, closer together than double precision separates. Nothing where the
/// limit is 0 or infinite. Throws what absolute_stability_limit() throws.
[[nodiscard]] std::optional<WorstUser> worst_user(const Device& device, const AbsoluteStabilityLimit& limit,
                                                  VirtualDamper damper = {}, const Progress& progress = {});

}  // namespace zwidth
