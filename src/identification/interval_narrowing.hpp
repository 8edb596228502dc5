#pragma once

#include <optional>
#include <string>

#include "zwidth/identification/identification.hpp"

namespace zwidth::internal {

/// Why no critical stiffness is sound where its interval is open (zwidth::is_inconclusive()), with the remedy.
[[nodiscard]] Finding interval_left_open(const StiffnessInterval& interval);

/// Why an answer's interval says that it is not to be relied on: there is none, as where a fit ran away and no number's
/// deviation is one; it is open; or it is wider than a factor of 1.4 where noise hides the crossover (coherence below 0.95):
/// of 1059 simulated sound answers one of these began 16 % above the truth.
[[nodiscard]] std::optional<Finding> doubt_of_interval(const Identification& result);

/// A normal distribution around a parameter that the data hardly show draws devices that contradict them. Where the
/// response shows the critical stiffness by itself, which does not hang on such parameters, they are taken as known.
/// Whether a softer crossover outside the lines may limit is judged by devices that explain the record (unseen_limit.hpp).
void narrow_interval(Identification& result);

}  // namespace zwidth::internal
