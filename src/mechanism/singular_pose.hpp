#pragma once

#include "zwidth/mechanism.hpp"

namespace zwidth::internal {

// rad or m to either side of a pose, for slopes: what the loops' rounding leaves of them is less than what counts.
inline constexpr double step_beside = 1e-3;

// Adds to tips_beside of a pose J towards the two poses, one step to either side of it on one way: its own rows, and in the
// directions that it lost the slope's part that no own row has. Nothing where there is none, or where it is there already.
void add_tip_beside(MechanismAtPose& at, const MechanismAtPose& before, const MechanismAtPose& after);

}  // namespace zwidth::internal
