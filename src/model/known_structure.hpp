#pragma once

#include "zwidth/model/device.hpp"
#include "zwidth/model/mechanism_key.hpp"

namespace zwidth::internal {

// Throws as require_one_direction() and, for coordinates of no mechanism, as require_no_coordinates(): for computations that know
// bodies, transfer functions and a direction of a mechanism.
inline void require_known_structure(const Device& device) {
  require_one_direction(device);
  if (!device.parameters().mechanism) require_no_coordinates(device);
}

// The same of computations that know the friction of bodies alone: a mechanism in which nothing rubs.
inline void require_known_friction(const Device& device) {
  require_known_structure(device);
  const auto& coordinates = device.parameters().coordinates;
  if (coordinates && !coordinates->frictions.empty()) require_no_coordinates(device);
}

// What moves with a force at the held point, kg: the masses of all bodies; of coordinates 1/(w' M^-1 w), of w: as it moves at once.
// 0 of a transfer function.
[[nodiscard]] double moving_mass(const Device& device);

// The force, at the actuator, that dry friction holds against a slow motion, where there is any: that of all bodies; of coordinates,
// of the slow motion q that a force there makes, sum F_i |w_i' q| / |w' q|.
[[nodiscard]] double dry_friction(const Device& device);

}  // namespace zwidth::internal
