#pragma once

#include <string_view>
#include <vector>

#include "design/sensitivities/design_parameter.hpp"
#include "zwidth/design/sensitivity.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {

/// set_parameter() that keeps the ratio of two rates: with loop.sampling_period the damper's own period is scaled.
void set_with_ratio(DeviceParameters& parameters, std::string_view key, double value);

/// design_parameters() and the damper's own delay, where the file has one. The ratio of the two periods is whole, and no number.
[[nodiscard]] std::vector<DesignParameter> numbers_of_two_rates(const Device& device);

/// stiffness_sensitivities() at the limit of a device whose damper runs in a loop of its own. With the gain inside q and that
/// outside g (TwoRateCurve) the loop is critical where F = g + 1/(C_out P) = 0, of K and the angle:
///
///     [F_K F_theta] (dK, dtheta) = -F_p dp
///
/// F_K, F_theta and F_p by differences at the crossover, extrapolated over steps until two agree; nothing is solved again, and
/// a number whose differences do not agree is left out.
[[nodiscard]] std::vector<Sensitivity> two_rate_sensitivities(const Device& device, const Crossover& limit);

/// absolute_stability_sensitivities() of such a device, whose loop knows_all_users(), with a damper. At the frequency of the
/// least K its slope is that of K alone (envelope theorem), by the same differences at the same angle. A delay or period that
/// leaves the limit unknown has no slope; none has where the limit is approached towards zero frequency.
[[nodiscard]] std::vector<Sensitivity> two_rate_users_sensitivities(const Device& device,
                                                                    const AbsoluteStabilityLimit& limit);

}  // namespace zwidth::internal
