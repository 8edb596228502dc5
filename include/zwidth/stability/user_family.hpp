#pragma once

#include <optional>

#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {

/// least <= greatest; equal: one value.
struct ValueRange {
  double least = 0.0;     ///< its lower end
  double greatest = 0.0;  ///< its upper end
};

/// The users that a device is meant for: every mass, damper and spring of these ranges, in any combination.
struct UserFamily {
  ValueRange mass;       ///< kg or kg m²
  ValueRange damping;    ///< N s/m or N m s/rad
  ValueRange stiffness;  ///< N/m or N m/rad
};

/// A family by the ranges that are told of it: what is absent is that of the device's own [operator].
struct UserRanges {
  std::optional<ValueRange> mass = {};       ///< kg or kg m^2
  std::optional<ValueRange> damping = {};    ///< N s/m or N m s/rad
  std::optional<ValueRange> stiffness = {};  ///< N/m or N m/rad
};

/// The device's own user where a range is not given.
[[nodiscard]] UserFamily user_family(const UserRanges& ranges, const User& own);

/// The user of a family that leaves the least stable wall, as far as the search sees.
struct WorstOfFamily {
  User user;                        ///< with whom the limit is lowest
  double critical_stiffness = 0.0;  ///< K_CR held by that user; 0: no wall is stable; infinity: all are, for every user
};

/// What a family of users makes of a device.
struct UserFamilyAnswer {
  UserFamily family;       ///< that was searched
  WorstOfFamily worst;     ///< of all its users
  CriticalStiffness free;  ///< of the device that nobody holds
};

/// Searches a family for the user with whom the critical stiffness is least.
///
/// What is certain: `critical_stiffness` is exact for `user`, so the least over the family is no higher; and by
/// absolute_stability_limit() it is no lower than the limit over all passive users. In between it is a search: the corners, and
/// five values of each range in all combinations, closer together towards the least; then pattern search within the box
/// from the best few of them. A narrow dip between them may be missed.
/// Throws Error (needs_bodies) for a transfer function, (invalid_argument) for a range that is negative, reversed or
/// not finite, and what critical_stiffness() throws.
[[nodiscard]] WorstOfFamily worst_of_family(const Device& device, const UserFamily& family, VirtualDamper damper = {},
                                            const Progress& progress = {});

}  // namespace zwidth
