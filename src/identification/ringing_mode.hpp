#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/record_fit.hpp"

namespace zwidth::internal {

// A mode that rings on from one segment of a record to the next leaves in each what the force of that segment did not
// cause. A fit beside what it leaves itself comes to it slowly, if at all: 1 to 2 % of damping, and of K_CR, too much.

/// Samples of segments over which the modes of the fitted device die out, as far as the records let them be longer.
/// Nothing where those of the response are long enough, or were asked for, or it is one of lines.
[[nodiscard]] std::optional<std::size_t> segment_for_modes(const RecordFit& found,
                                                           std::span<const Recording> recordings,
                                                           const IdentifyOptions& options);

/// Why a limit at such a mode is not known: the records are too short for it to die out over a segment.
[[nodiscard]] std::optional<Finding> doubt_of_ringing(const Identification& found,
                                                      std::span<const Recording> recordings,
                                                      const IdentifyOptions& options);

}  // namespace zwidth::internal
