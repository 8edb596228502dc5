#pragma once

#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// The continuous response on the unit circle: s = (2/T)(z - 1)/(z + 1), so that angle t stands for the frequency
// (2/T) tan(t/2). T is chosen near the poles. Not a sampling of the plant.
SampledPlant bilinear_plant(const ModalForm& form);

}  // namespace zwidth::internal
