#pragma once

#include <optional>

#include "zwidth/design/wall_recommendation.hpp"
#include "zwidth/finding.hpp"

namespace zwidth::internal {

// Holds a device with a proposed wall against what was asked, by a route that shares nothing with the one that found it:
// matrix exponential and closed-loop poles of the loop, of the loop grown by the gain margin and of both held by passive
// users; gain crossovers of the state space's response on a grid, refined, for the phase margin. What contradicts is
// refused in `trust`.
void check_wall(const Device& walled, const RecommendationOptions& options, bool any_user, Trust& trust);

/// The device whose wall has neither stiffness nor damping; its filters stay.
[[nodiscard]] Device without_wall(const Device& device);

/// Why a wall that some passive user bounds is none worth rendering: below a millionth of what the device renders alone.
/// Empty where it is one.
[[nodiscard]] std::optional<Finding> why_negligible(const Device& walled);

}  // namespace zwidth::internal
