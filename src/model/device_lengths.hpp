#pragma once

// The points of a device that the loop can name, and the lengths along which it is stiff or damped, as sums of motions of
// its bodies or coordinates. A force at a point or along a length acts with the same weights.

#include <cstddef>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

struct Weight {
  std::size_t of = 0;  // a body or coordinate
  double weight = 1.0;
};
using Weights = std::vector<Weight>;  // those that are not 0

// How a point moves: a body's position is its own.
[[nodiscard]] Weights weights_of(const Device& device, std::size_t point);

// How many points there are: as many as bodies.
[[nodiscard]] std::size_t points_of(const Device& device);

// From a force on bodies or coordinates to a sum of their positions.
struct WeightedPath {
  Weights force_at;
  Weights position_of;
};

struct DeviceLength {
  Weights weights;
  double stiffness = 0.0;
  double damping = 0.0;
};
// Bodies to ground, then links; or the elements of coordinates. The user is none of them.
[[nodiscard]] std::vector<DeviceLength> lengths_of(const Device& device);

}  // namespace zwidth::internal
