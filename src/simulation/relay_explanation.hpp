#pragma once

#include <string>
#include <vector>

#include "zwidth/simulation/relay.hpp"

namespace zwidth::internal {

/// Whether all trials are at one oscillation: within 15 %.
[[nodiscard]] bool agree(const RelayMean& mean);

/// The mean against the stiffest stable wall of linear theory.
[[nodiscard]] LimitReading limit_reading(const RelayMean& mean, const CriticalStiffness& linear);

/// See RelayResult::explanation; requires mean, prediction and limit_reading.
[[nodiscard]] std::vector<std::string> relay_explanation(const RelayResult& result);

}  // namespace zwidth::internal
