#pragma once

#include <cstddef>

#include "zwidth/simulation/simulate.hpp"

namespace zwidth::results {

/// The samples that a picture of a motion needs: the last; of equally many instants each the first, and those at which what was measured,
/// the command or a position is least and largest. All where they are no more than `most`, which is at least 100.
[[nodiscard]] Trajectory envelope_of(const Trajectory& motion, std::size_t most);

}  // namespace zwidth::results
