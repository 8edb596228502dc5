#pragma once

#include <vector>

#include "design/sensitivities/design_parameter.hpp"
#include "zwidth/design/design_target.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

// Of more bodies than all numbers are followed for, how far each may go.
inline constexpr double factor_of_many_bodies = 10.0;

// Takes those numbers out of `parameters` that move the limit with any user least, where the device has too many bodies to
// follow all: they are returned. Several threads tell the progress.
[[nodiscard]] std::vector<DesignParameter> take_out_least(const Device& device, WallNumber number,
                                                          double limit_frequency, const Progress& progress,
                                                          std::vector<DesignParameter>& parameters);

}  // namespace zwidth::internal
