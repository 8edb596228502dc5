#pragma once

#include <optional>
#include <vector>

#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// The real poles 0 < z < 1 of a loop (K + B v) P on a grid: K(z) = -1/P(z) - B v(z). Where K is greatest between two of
// them they meet as K rises, and become a pair: from there on the contact swings.
class RealPoles {
 public:
  RealPoles(const FilteredPlant& plant, double velocity_filter_hz);

  // The K at which the slowest ones meet; absent where they do not on the grid.
  [[nodiscard]] std::optional<double> meeting(double damping) const;

 private:
  struct Point {
    double spring = 0.0;    // -1/P
    double velocity = 0.0;  // v
  };
  std::vector<Point> points_;  // from z = 1 on, by equal factors of ln z
};

}  // namespace zwidth::internal
