#pragma once

#include <complex>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// A gain crossover: |C P| = 1 at z = e^{j angle}.
struct UnitGainPoint {
  double angle = 0.0;  // (0, pi]
  double phase = 0.0;  // of -C P, (-pi, pi]
};

// All of them, by rising angle: as complete as the crossings of the gain locus. wall.stiffness is needed.
[[nodiscard]] std::vector<UnitGainPoint> unit_gain_points(const FilteredPlant& plant, const Wall& wall);

// C P at z = e^{j angle}, 0 < angle <= pi.
[[nodiscard]] std::complex<double> loop_gain(const FilteredPlant& plant, const Wall& wall, double angle);

// The lag, 0 to 2 pi, that takes the point to -1.
[[nodiscard]] double lag_to_instability(const UnitGainPoint& point);

}  // namespace zwidth::internal
