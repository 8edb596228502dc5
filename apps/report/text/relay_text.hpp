#pragma once

#include <string>

#include "zwidth/simulation/relay.hpp"

namespace zwidth::report {

/// The answer for a reader: every trial, their mean, the predictions, and what it all means for a wall.
[[nodiscard]] std::string relay_text(const RelayResult& result);

}  // namespace zwidth::report
