#pragma once

#include <optional>
#include <span>

#include "zwidth/signal/frequency_response.hpp"

namespace zwidth::internal {

/// Dry friction that the recorded motion shows beside its measured response.
struct FrictionBesideResponse {
  double evidence = 0.0;            ///< chi-squared of two degrees of freedom
  /// |c| <|v|> / <v^2>, N s/m: what the response makes of it at least, for G has the damping of friction already.
  double equivalent_damping = 0.0;
};

/// Looks for friction at the sensed body without a model of the device.
///
///     Y - H_Y F = c G (S - H_S F) + rest,   S: lines of sign v_M,   v_M: velocity of the motion G F
///
/// G: the measured response; H_Y, H_S: what is locally proportional to the force, lines around each weighted alike. What is
/// left of the sign is what friction does that no damping does: its harmonics. c is complex, so that an unknown delay of
/// the actuator does no harm. Nothing where the record is too short, does not move, or the response has too few lines.
[[nodiscard]] std::optional<FrictionBesideResponse> find_friction_beside(const FrequencyResponse& response,
                                                                         std::span<const double> force,
                                                                         std::span<const double> position);

}  // namespace zwidth::internal
