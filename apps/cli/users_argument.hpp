#pragma once

#include <string>

#include "zwidth/stability/user_family.hpp"

namespace zwidth::cli {

/// Reads "mass=0:2,damping=0:30,stiffness=1000": some of the three keys (inertia is the mass of a rotary axis), each
/// with a range LEAST:GREATEST or one value, plain or with units ("mass=0:500 g"). Throws BadInput that names the key.
[[nodiscard]] UserRanges user_ranges(const std::string& text, Motion motion);

}  // namespace zwidth::cli
