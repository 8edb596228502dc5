#pragma once

#include "cli/rig_arguments.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::cli {

/// Whether the damper of wall, limit or relay may run where it is asked to: before a drive is opened. Throws BadInput.
void check_place_of_damper(const RigArguments& arguments, const Device& device);

}  // namespace zwidth::cli
