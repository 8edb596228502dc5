#pragma once

#include <string>
#include <vector>

#include "zwidth/simulation/relay.hpp"

namespace zwidth::internal {

/// Whether all trials are at one oscillation: within 15 %.
[[nodiscard]] bool agree(const RelayMean& mean);

/// The mean of trials that agree against the stiffest stable wall of linear theory.
[[nodiscard]] LimitReading limit_reading(const RelayMean& mean, const CriticalStiffness& linear);

/// See RelayResult::explanation; requires prediction, limit_reading, and the mean where the trials agree.
[[nodiscard]] std::vector<std::string> relay_explanation(const RelayResult& result, const RelayMean& over_all);

}  // namespace zwidth::internal
