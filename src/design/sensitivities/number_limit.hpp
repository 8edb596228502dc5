#pragma once

#include <optional>
#include <vector>

#include "stability/loop/damper_response.hpp"
#include "zwidth/design/wall_number.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::internal {

// The limit of a wall's stiffness with its damper as it is, or of a damper alone: what both have.
struct NumberLimit {
  struct Crossing {
    double frequency = 0.0;  // rad/s
    double value = 0.0;      // of the number
    Oscillator limited_by;
  };
  double value = 0.0;  // infinite where nothing bounds it, 0 where there is none, NaN where refused
  std::optional<Crossing> at;
  std::vector<Crossing> crossings;  // all, by rising frequency
  Trust trust;
};

// With the device's own [operator], checked by a second route.
[[nodiscard]] NumberLimit number_limit(const Device& device, WallNumber number);
// The same of K as it is computed first.
[[nodiscard]] NumberLimit unchecked_number_limit(const Device& device, WallNumber number);

// Nothing pulls the sensed position back, with K = 0 or no wall: it keeps a pole at z = 1, which is no instability.
[[nodiscard]] bool is_position_free(const DeviceParameters& parameters);

// The device's wall C = g u + d at one frequency with that number g free.
[[nodiscard]] WallResponse response_of(const Device& device, WallNumber number, double frequency);

}  // namespace zwidth::internal
