#pragma once

#include <span>

#include "zwidth/identification/measured_response.hpp"

namespace zwidth::internal {

/// Doubts a critical stiffness unless the recordings bound what dry friction may have made of it.
///
/// What a record shows beside its response (recorded_sliding) or two of them between each other (friction_between)
/// bounds the friction: estimate and two deviations, times what friction elsewhere in the device may be more. Sound:
/// without as much the critical stiffness would be lower by less than a part of its interval, or a few per cent, and
/// no other estimate contradicts. A dependence on the force that is friction's gets its size.
void judge_friction(MeasuredResponse& measured, std::span<const Recording> recordings,
                    std::span<const FrequencyResponse> responses, const FrequencyResponseOptions& options);

}  // namespace zwidth::internal
