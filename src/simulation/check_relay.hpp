#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "zwidth/error.hpp"
#include "zwidth/simulation/limit_cycle.hpp"

namespace zwidth::internal {

/// Throws Error (invalid_argument) for a relay outside its domain.
inline void check_relay(const Relay& relay) {
  if (!(std::isfinite(relay.amplitude) && relay.amplitude > 0.0)) {
    throw Error(ErrorCode::invalid_argument,
                "relay amplitude is " + fmt::format("{}", relay.amplitude) + "; must be > 0");
  }
  if (!(std::isfinite(relay.hysteresis) && relay.hysteresis >= 0.0)) {
    throw Error(ErrorCode::invalid_argument,
                "relay hysteresis is " + fmt::format("{}", relay.hysteresis) + "; must be >= 0");
  }
}

}  // namespace zwidth::internal
