#pragma once

#include <cmath>
#include <string>

#include "zwidth/error.hpp"
#include "zwidth/simulation/limit_cycle.hpp"

namespace zwidth::internal {

/// Throws Error (invalid_argument) for a relay outside its domain.
inline void check_relay(const Relay& relay) {
  if (!(std::isfinite(relay.amplitude) && relay.amplitude > 0.0)) {
    throw Error(ErrorCode::invalid_argument, "relay amplitude is " + std::to_string(relay.amplitude) + "; must be > 0");
  }
  if (!(std::isfinite(relay.hysteresis) && relay.hysteresis >= 0.0)) {
    throw Error(ErrorCode::invalid_argument,
                "relay hysteresis is " + std::to_string(relay.hysteresis) + "; must be >= 0");
  }
}

}  // namespace zwidth::internal
