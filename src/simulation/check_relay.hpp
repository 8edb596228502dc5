#pragma once

#include <cmath>
#include <string>

#include "zwidth/error.hpp"
#include "zwidth/simulation/limit_cycle.hpp"

namespace zwidth::internal {

/// Throws Error (invalid_argument) for a relay outside its domain.
inline void check_relay(const Relay& relay) {
  if (!(std::isfinite(relay.amplitude) && relay.amplitude > 0.0)) {
    throw Error(ErrorCode::invalid_argument,
                {.code = ProblemCode::relay_amplitude_not_positive, .evidence = {{"value", relay.amplitude}}});
  }
  if (!(std::isfinite(relay.hysteresis) && relay.hysteresis >= 0.0)) {
    throw Error(ErrorCode::invalid_argument,
                {.code = ProblemCode::relay_hysteresis_below_zero, .evidence = {{"value", relay.hysteresis}}});
  }
}

}  // namespace zwidth::internal
