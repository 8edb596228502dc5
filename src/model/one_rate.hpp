#pragma once

namespace zwidth::internal {

// How often the damper runs while the spring runs once: the whole number or whole part whose period is nearest.
[[nodiscard]] double rate_ratio(double loop_period, double damper_period);

}  // namespace zwidth::internal
