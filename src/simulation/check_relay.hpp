#pragma once

#include "require_argument.hpp"
#include "zwidth/simulation/limit_cycle.hpp"

namespace zwidth::internal {

/// Throws Error (invalid_argument) for a relay outside its domain.
inline void check_relay(const Relay& relay) {
  require_positive({"relay amplitude", relay.amplitude});
  require_not_negative({"relay hysteresis", relay.hysteresis});
}

}  // namespace zwidth::internal
