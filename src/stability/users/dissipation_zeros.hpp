#pragma once

// Where termination discs grow without bound, or nearly so: the zeros of Re Y = w² q^H Dmp q.

#include <cstddef>
#include <vector>

#include "stability/users/sharp_zero.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

struct DissipationZeros {
  explicit DissipationZeros() = default;
  /// Of a device without user that has bodies or coordinates, motion_polynomials() allowing. `nyquist`: in rad/s.
  DissipationZeros(const Device& device, double nyquist);

  struct Zero {
    double position = 0.0;  // rad/s
    double depth = 0.0;     // distance from the axis of frequencies, rad/s
  };
  std::vector<SharpZero> sharp;  ///< by rising frequency
  std::vector<Zero> others;      ///< of positive real part, all that are not sharp
  /// All zeros are among these: but for what modes and zeros of motions make of it, discs are smooth elsewhere.
  bool are_complete = false;
  /// The discs fall so slowly with frequency that their sum over aliases is infinite.
  bool discs_diverge = false;
  /// What could not be told apart, or a device of too many bodies some of which are damped far less than others.
  bool is_unknown = false;
};

}  // namespace zwidth::internal
