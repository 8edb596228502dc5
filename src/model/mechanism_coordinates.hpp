#pragma once

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// Puts the mechanism of these parameters to its pose: their coordinates, and which points of them the loop names. Throws Error
// (invalid_argument) as device_of_mechanism().
using PutToPose = void (*)(DeviceParameters& parameters);

// The mechanism room's function, which the model's does not know; null in a program without that room.
[[nodiscard]] PutToPose put_to_pose() noexcept;

// The room leaves it here when it is loaded.
struct PutToPoseRegistration {
  explicit PutToPoseRegistration(PutToPose put) noexcept;
};

// Of a mechanism whose numbers have changed since it was put to a pose.
[[nodiscard]] inline bool lacks_coordinates(const DeviceParameters& parameters) {
  return parameters.mechanism && !parameters.coordinates;
}

}  // namespace zwidth::internal
