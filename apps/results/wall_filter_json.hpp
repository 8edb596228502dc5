#pragma once

#include "results/json.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::results {

/// The filters of the wall as an array: the keys of [[wall.filter]], and the section as it runs: `z` (numerator,
/// denominator by falling powers of z) and `delta` (by rising powers of z - 1).
[[nodiscard]] Json wall_filters_json(const Wall& wall, double sampling_period);

}  // namespace zwidth::results
