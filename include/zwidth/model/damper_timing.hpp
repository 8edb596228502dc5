#pragma once

#include "zwidth/model/device.hpp"

namespace zwidth {

/// When the wall's damper runs.
struct DamperTiming {
  double sampling_period = 0.0;  ///< s
  double delay = 0.0;            ///< s, in addition to the zero-order hold
};

/// Its own period and delay, and the loop's where it has none.
[[nodiscard]] DamperTiming damper_timing(const Loop& loop);

/// Whether the damper runs at another time than the spring. One with the loop's own period and delay does not.
[[nodiscard]] bool has_damper_loop(const Loop& loop);

/// Whether the wall has a damper, and it runs at another time than the spring.
[[nodiscard]] bool runs_damper_apart(const DeviceParameters& parameters);

/// Throws Error (invalid_argument) where has_damper_loop(): for computations of one rate, which would answer for another
/// device.
void require_one_rate(const Device& device);

/// Throws Error (invalid_argument) where has_damper_loop(): of the structure that a record is fitted with, around which that
/// damper may have been closed.
void require_open_damper(const Device& device);

/// The same device whose damper runs with its spring: what a spring without a damper is judged by.
[[nodiscard]] Device with_one_rate(const Device& device);

/// The same device whose loop has the damper's own period and delay: what a damper without a spring is judged by.
[[nodiscard]] Device with_loop_of_damper(const Device& device);

/// The same device whose spring and damper both run at the slower of its two rates, with that one's delay: what a damper of its
/// own is compared with. The device itself where the damper runs with its spring.
[[nodiscard]] Device at_slower_rate(const Device& device);

}  // namespace zwidth
