#pragma once

#include <cstddef>

#include "model/device_lengths.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth::internal {

// How many poles at s = 0 the structure implies: one for every set of bodies that no spring ties to ground, directly or
// through others, and one more for every set of those sets that no damper ties to ground either.
[[nodiscard]] std::size_t poles_at_zero(const Device& device);

// How many of them the path sees.
[[nodiscard]] std::size_t poles_at_zero_seen(const Device& device, const WeightedPath& path);

// Poles at s = 0 that the path does not see are cancelled by zeros there, which rounding displaces: the sign of what is
// left of them would decide whether the loop is stable at low gains. Takes them out of their term.
void cancel_at_zero(ModalForm& form, std::size_t seen);

}  // namespace zwidth::internal
