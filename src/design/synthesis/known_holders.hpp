#pragma once

#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// The device as held by those who are known: by nobody, always first, and by its own [operator] where it has one.
///
/// A wall that is to run must be stable with each of them. All that the file says of the uncertainty stays, but for that
/// of a user who is not there.
[[nodiscard]] std::vector<Device> known_holders(const Device& device);

}  // namespace zwidth::internal
