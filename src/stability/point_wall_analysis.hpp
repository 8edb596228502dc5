#pragma once

#include "zwidth/model/device.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::internal {

// analyze() of a device of which is_point_wall(): the limit with the file's user and with nobody, the wall of the file, and
// bounds of the limit for any passive grasp. Throws Error (invalid_argument) as point_wall_limit().
[[nodiscard]] Analysis point_wall_analysis(const Device& device, const AnalysisOptions& options);

}  // namespace zwidth::internal
