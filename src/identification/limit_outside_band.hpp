#pragma once

#include <string>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

constexpr const char* delay_key = "loop.delay";
constexpr const char* lag_key = "actuator.time_constant";

/// Why a critical stiffness is not in the data whose crossover lies outside the band that was excited, with the remedy.
/// All in rad/s.
[[nodiscard]] std::string outside_band_reason(double limiting, double lowest, double highest);

/// Delay and lag are each between 0 and their sum, which is all that a band below the limit shows of them: how they
/// share it counts as a number from that range, neither as known nor as open beyond it (draws stay within bounds).
/// The same device where its delay is not in its uncertainty.
[[nodiscard]] Device with_shared_lateness(const Device& device);

}  // namespace zwidth::internal
