#pragma once

#include "io/device_reading.hpp"
#include "zwidth/model/wall_filter.hpp"

namespace zwidth::internal {

/// Reads one [[wall.filter]]; what its type does not have, or lacks, is refused in the reading. Ranges are for
/// find_problem() to check.
[[nodiscard]] WallFilter read_wall_filter(TableReader& reader);

}  // namespace zwidth::internal
