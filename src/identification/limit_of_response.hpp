#pragma once

#include <string>
#include <vector>

#include "zwidth/identification/measured_stiffness.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/signal/frequency_response.hpp"

namespace zwidth::internal {

/// The interval of a limit whose structure does not explain what was recorded: it reaches to both ends of the softest crossover that the
/// response shows by itself.
///
/// What bends the response between its lines, and no structure explains, moves the device's own crossover as much; a fit through
/// all lines averages it away. Where the phase falls slowly that is far:
///
///     d log K = (d log K / d w) / (d phase / d w) d phase
///
/// `fitted` as it is where the response shows no crossover, or another loop's: bodies were `locked`, its rate is not the
/// structure's, or it is refused.
[[nodiscard]] Interval with_limit_of_response(const Interval& fitted, const FrequencyResponse& response,
                                              const Device& structure, const std::vector<std::string>& locked);

}  // namespace zwidth::internal
