#pragma once

#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// The sum of the terms' magnitudes over the magnitude of their sum, at an angle in [0, pi]: 1 without cancellation,
// infinite where the response vanishes, NaN at angle 0 with an integrator.
double cancellation(const SampledPlant& plant, double angle);

}  // namespace zwidth::internal
