#pragma once

#include <memory>

#include "zwidth/model/device.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"

namespace zwidth::internal {

// Whether a wall is stable, by Routh's count of the poles outside a circle a little inside or outside the unit circle:
// from the same matrices as closed_loop_poles_minus_one(), but quicker for small plants with delays. In double-double
// with bounds of its rounding; the circles leave room for that of the matrices.
class RouthCount {
 public:
  // A wall without damping has none in surely() either.
  RouthCount(const DiscreteStateSpace& plant, const Wall& wall);

  // Whether it is quicker than eigenvalues.
  [[nodiscard]] static bool suits(const DiscreteStateSpace& plant);

  // Whether that wall is surely stable (unstable). False where it is not, or too near to tell.
  [[nodiscard]] bool surely(bool stable, double stiffness, double damping) const;

 private:
  struct Circles;
  std::shared_ptr<const Circles> circles_;
};

}  // namespace zwidth::internal
