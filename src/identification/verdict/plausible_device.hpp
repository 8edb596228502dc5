#pragma once

#include <optional>
#include <vector>

#include "zwidth/finding.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::internal {

// Numbers of a fitted device that are powers of ten off: one of force, motion and time is not in SI units. `known`: the structure
// where its values are the device's (`is_known`); null where nothing was known.

/// Why no answer is one in SI units: each mass or inertia is about a hundred times the structure's or more, or a hundredth or
/// less; where nothing was known, each is one that no haptic device has. A wrong unit scales them all; a single heavy body is a
/// held one.
[[nodiscard]] std::optional<Finding> doubt_of_masses(const Device& fitted, const Device& structure, bool is_known);

/// What is odd, but may be: a sampling period or a delay that no haptic device has, a period far from the record's, a mass ten
/// times the structure's or a tenth.
[[nodiscard]] std::vector<Remark> implausible_device(const Device& fitted, const Device* known,
                                                     std::optional<double> recorded_period);

}  // namespace zwidth::internal
