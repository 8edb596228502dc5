#pragma once

#include "zwidth/identification/excitation.hpp"

namespace zwidth::internal {

/// Plays the excitation through the device: see excite(options, device).
[[nodiscard]] ExcitationCheck check_excitation(const Excitation& excitation, const Device& device);

}  // namespace zwidth::internal
