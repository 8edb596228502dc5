#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "identification/model/rivals/rival.hpp"

namespace zwidth::internal {

// A rival a file, named for it: what it is, its numbers, what is believed of them and why. CONTRIBUTING.md: how one is added;
// docs/identification_method.md: how it reaches the interval.
[[nodiscard]] Rival constant_force();
[[nodiscard]] Rival coulomb_friction();
[[nodiscard]] Rival presliding();
[[nodiscard]] Rival link_friction();
[[nodiscard]] Rival link_presliding();
[[nodiscard]] Rival drag();
[[nodiscard]] Rival damping_drift();
[[nodiscard]] Rival delay_drift();
[[nodiscard]] Rival actuator_lag();
[[nodiscard]] Rival ground_spring();
[[nodiscard]] Rival stiffening_spring();
[[nodiscard]] Rival drive_saturation();
[[nodiscard]] Rival drive_dead_band();

/// All that a fit has, in the order in which they are added.
[[nodiscard]] std::span<const Rival> rivals();

/// Adds every rival to the parts that have the device's numbers, and puts those of the device first, as DeviceFamily takes them,
/// behind them its drifts.
std::vector<AddedRival> add_rivals(const RivalSetting& setting, ModelParts& parts);
/// Those alone that are linear: all that shows in a response.
std::vector<AddedRival> add_linear_rivals(const RivalSetting& setting, ModelParts& parts);

}  // namespace zwidth::internal
