#pragma once

#include <vector>

#include "mechanism/mechanism_text.hpp"
#include "zwidth/mechanism.hpp"

namespace zwidth::internal {

// at_pose() of a mechanism whose texts are these, by MuJoCo. The program loads it on demand.
[[nodiscard]] MechanismAtPose mujoco_at_pose(const MechanismFile& file, const std::vector<MechanismText>& texts);

}  // namespace zwidth::internal
