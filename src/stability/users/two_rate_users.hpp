#pragma once

#include <optional>

#include "zwidth/model/device.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth::internal {

// The limit over all passive users of a device whose damper runs in a loop of its own and is closed. At each frequency of the
// damper's rate the plant fills a disc; closing the damper maps it to a disc,
//
//     p -> p/(1 + g p), g = B v:   centre (c + conj(g) A)/D,  radius r/D,   A = |c|² - r²,  D = 1 + 2 Re[g c] + |g|² A
//
// and the N aliases of the spring's rate, at each of which a user may be another, add up. Source: theory, section 8.
//
// Nothing where the damper is the slower one, and where the delays of the two differ by no whole number of the damper's periods:
// their paths would see the aliases with different phases. The least over all frequencies is found by a scan, and not shown
// to be the least in between. Throws as absolute_stability_limit().
[[nodiscard]] std::optional<AbsoluteStabilityLimit> two_rate_absolute_stability(const Device& device,
                                                                                const CriticalStiffness& nobody);

}  // namespace zwidth::internal
