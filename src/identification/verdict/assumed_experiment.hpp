#pragma once

#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::internal {

/// What no record shows, and is taken to be so: who held the device, and what the force's column is. `is_known`: the structure's
/// numbers are those of a device file.
[[nodiscard]] std::vector<Remark> assumptions_of_experiment(const Device& structure, bool is_known,
                                                            const std::vector<std::string>& locked);

}  // namespace zwidth::internal
