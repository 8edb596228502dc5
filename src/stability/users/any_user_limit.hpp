#pragma once

#include <optional>

#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth::internal {

// The damper's periods by which the spring's force comes later, whole where they are nearly; nothing where the damper is slower.
[[nodiscard]] std::optional<double> damper_periods_later(const Loop& loop);

// Whether the limit over all passive users is known: the damper is as fast as the spring or faster, and their delays differ by
// whole periods of the damper. Otherwise the two forces see the aliases with different phases.
[[nodiscard]] bool knows_all_users(const Loop& loop);
// The same, and not a mechanism, of whose grasps one rate alone is known.
[[nodiscard]] bool knows_all_users(const Device& device);

// Whether a lower bound of that limit is known: the damper is as fast as the spring or faster.
[[nodiscard]] bool bounds_all_users(const Loop& loop);
[[nodiscard]] bool bounds_all_users(const Device& device);

// absolute_stability_limit() of the device with the damper of its wall, at one rate or two. Nothing where it is not known;
// refused where the limit of nobody is.
[[nodiscard]] std::optional<AbsoluteStabilityLimit> any_user_limit(const Device& device, const Progress& progress = {});

// The same; throws Error (invalid_argument) as require_one_rate() where it is not known.
[[nodiscard]] AbsoluteStabilityLimit known_any_user_limit(const Device& device, const Progress& progress = {});

// How that limit of two rates was found: over a grid of frequencies, and whether it is a bound.
[[nodiscard]] Remark any_user_limit_scanned(const Loop& loop);

}  // namespace zwidth::internal
