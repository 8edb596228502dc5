#pragma once

#include <optional>

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

/// That the record shows another delay than the structure has.
[[nodiscard]] Remark ignored_delay_remark(double shown, double given);

}  // namespace zwidth::internal
