#pragma once

#include "zwidth/model/device.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// Largest |z| of the closed loop 1 + C(z) P(z) = 0 by bisection on the radius of a circle that holds all poles: their
// number inside is the winding number of z^L D D_v + (K D_v + B (c/T) delta) S. For delays of so many samples that
// eigenvalues, whose cost grows with the cube, would take minutes; here it grows with L. With K = 0 the pole at z = 1 of a
// position that nothing holds is left out.
double spectral_radius_by_winding(const FilteredPlant& plant, const Wall& wall);

}  // namespace zwidth::internal
