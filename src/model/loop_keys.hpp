#pragma once

namespace zwidth::internal {

// Keys of a device (parameter()) that are asked for by name.
inline constexpr const char* key_of_delay = "loop.delay";
inline constexpr const char* key_of_lag = "actuator.time_constant";

}  // namespace zwidth::internal
