#pragma once

#include <optional>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// The least delay, s, that added to the device's own puts a pole of the loop with its own wall on the unit circle; the
// loop is stable as it is. Nothing where no delay does: |C P| < 1 at every angle and every fraction of a sample.
//
// With t samples of delay in all, P_t = z^-m P_(t - m): at which angles |C P_t| = 1, and how much lag takes each of
// these points to -1, is periodic in t but for the lag's m * angle. So one period holds everything. It is followed in
// steps that are halved until every crossover has one successor; a pair that is born or dies is looked at for
// whether it straddles -1, and one that is born or dies alone, at Nyquist, for whether it does so at -1. The least m + fraction is then solved to rounding.
[[nodiscard]] std::optional<double> exact_delay_margin(const Device& device);

}  // namespace zwidth::internal
