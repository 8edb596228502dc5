#pragma once

#include <span>

#include "zwidth/identification/measured_response.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::internal {

/// Sets the units of a response to those that the columns of its recordings state by their names.
void state_units(MeasuredResponse& measured, std::span<const Recording> recordings);

}  // namespace zwidth::internal
