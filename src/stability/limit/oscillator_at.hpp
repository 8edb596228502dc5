#pragma once

#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {

// The modal term of largest magnitude at that angle, the lag's term shared out to the modes it stems from.
Oscillator oscillator_at(const SampledPlant& plant, double angle);

}  // namespace zwidth::internal
