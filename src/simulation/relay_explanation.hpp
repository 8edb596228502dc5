#pragma once

#include <string>
#include <vector>

#include "zwidth/simulation/relay.hpp"

namespace zwidth::internal {

/// Whether all trials are at one oscillation: within 15 %.
[[nodiscard]] bool agree(const RelayMean& mean);

/// What the trials settle at, slowest first: "6.35 Hz (12.02 kN/m, 1 trial) and 64.3 to 65.1 Hz (...)". A frequency within
/// 15 % of the slowest of a group is that group's.
[[nodiscard]] std::string oscillations_text(const RelayResult& result);

/// The mean of trials that agree against the stiffest stable wall of linear theory.
[[nodiscard]] LimitReading limit_reading(const RelayMean& mean, const CriticalStiffness& linear);

/// See RelayResult::explanation; requires a trial that oscillates, prediction, limit_reading, and the mean
/// where the trials agree.
[[nodiscard]] std::vector<Finding> relay_explanation(const RelayResult& result);

}  // namespace zwidth::internal
