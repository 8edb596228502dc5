#pragma once

#include <array>
#include <cstddef>

namespace zwidth::internal {

inline constexpr std::size_t most_numbers_of_law = 3;

/// A force and how it changes.
struct LawForce {
  double force = 0.0;        ///< N or N m, on the body
  double by_position = 0.0;  ///< N/m or N m/rad
  double by_velocity = 0.0;  ///< N s/m or N m s/rad
  std::array<double, most_numbers_of_law> by_number = {};
};

/// Where a law is asked: the position and velocity of its body.
struct LawState {
  double position = 0.0;  ///< m or rad
  double velocity = 0.0;  ///< m/s or rad/s
  double share = 0.0;     ///< of the record that is over, 0 to 1
};

/// A force beside the linear device, smooth in what it hangs on. `numbers`: its own, in its order.
using ForceLaw = LawForce (*)(const LawState& state, const double* numbers);

}  // namespace zwidth::internal
