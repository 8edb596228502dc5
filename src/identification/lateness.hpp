#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::internal {

inline constexpr const char* delay_key = "loop.delay";
inline constexpr const char* lag_key = "actuator.time_constant";

/// Delay and lag are each between 0 and their sum, which is all that a band below the limit shows of them: how they
/// share it counts as a number from that range, neither as known nor as open beyond it (draws stay within bounds).
[[nodiscard]] Device with_shared_lateness(const Device& device);

/// The device with its delay known only to this variance (s^2) more.
[[nodiscard]] Device with_open_delay(const Device& device, double variance);

/// The delay of an estimate that is significantly and notably (2 % of the sampling period) another than the loop's; s.
[[nodiscard]] std::optional<double> other_delay(const ParameterEstimate& estimate, const Loop& loop);

/// Why a fit that finds less delay and lag than a known structure states is not to be trusted: rows that pair a force with a later
/// position hide it. By 4 deviations and a tenth of the sampling period at least.
[[nodiscard]] std::optional<Finding> doubt_of_lost_delay(const Device& structure,
                                                         const std::vector<ParameterEstimate>& estimates);

/// That the record shows another delay than the structure has.
[[nodiscard]] Finding ignored_delay(double shown, double given);

/// Whether nobody states the delay: neither a device file nor who takes the structure's as it is.
[[nodiscard]] bool assumes_delay(const Device& structure, IdentifyOptions::StructureValues values,
                                 IdentifyOptions::LoopDelay loop_delay);

/// Why no delay was looked for of a structure that states none: so few lines determine no more numbers.
[[nodiscard]] Finding hidden_delay(std::size_t lines, std::size_t numbers);

/// Where a delay that nobody stated was not to be fitted, and the interval of the same fit with it begins more than 10 % lower, or
/// has none: the record does not tell that there is no delay.
[[nodiscard]] std::optional<Finding> doubt_of_open_delay(const Device& with, const Device& without);

/// Why a critical stiffness is not in the data whose crossover lies outside the band that was excited, with the remedy.
/// All in rad/s.
[[nodiscard]] Finding limit_outside_band(double limiting, double lowest, double highest);

}  // namespace zwidth::internal
