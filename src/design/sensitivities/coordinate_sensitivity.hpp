#pragma once

#include <vector>

#include "zwidth/design/sensitivity.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {

/// stiffness_sensitivities() of a device of coordinates, at its limit. On z = e^{j theta}, L(theta; p) = -1/(F P) - B v:
///
///     dK/dp = Re L_p - Im L_p Re L_theta / Im L_theta
///
/// L_p and L_theta by differences at the crossover, extrapolated over steps until two agree: for each step the mechanism is put to
/// its pose again, and no limit is searched again. A number whose differences do not agree is left out.
[[nodiscard]] std::vector<Sensitivity> coordinate_sensitivities(const Device& device, const Crossover& limit);

/// absolute_stability_sensitivities() of a device along a normal of a mechanism: differences of any_grasp_limit(). Those of
/// nobody where the limit needs no user.
[[nodiscard]] std::vector<Sensitivity> any_grasp_sensitivities(const Device& device,
                                                               const AbsoluteStabilityLimit& limit);

}  // namespace zwidth::internal
