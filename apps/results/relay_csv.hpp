#pragma once

#include <string>

#include "zwidth/simulation/relay.hpp"

namespace zwidth::results {

/// "time_s,force_1,position_1,force_2,...": the records of all trials side by side, 17 significant digits.
[[nodiscard]] std::string relay_csv(const RelayResult& result);

}  // namespace zwidth::results
