#pragma once

#include <span>
#include <string>

#include "zwidth/identification/measured_response.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::internal {

/// Sets the units of a response to those that the columns of its recordings state by their names.
void state_units(MeasuredResponse& measured, std::span<const Recording> recordings);

/// "0.0012 N m" and "23 N m/rad", in what the columns state; "0.0012 N (N m where it turns)" where they state nothing.
[[nodiscard]] std::string force_in_words(double force, const MeasuredResponse& measured);
[[nodiscard]] std::string stiffness_in_words(double stiffness, const MeasuredResponse& measured);

}  // namespace zwidth::internal
