#pragma once

#include <optional>
#include <span>

#include "zwidth/identification/measured_response.hpp"

namespace zwidth::internal {

/// Dry friction of the sensed body, N or N m.
struct HiddenFriction {
  double force = 0.0;      ///< >= 0
  double deviation = 0.0;  ///< one standard deviation of it

  [[nodiscard]] double most() const { return force + 2.0 * deviation; }
};

/// The friction that recordings show beside their smooth responses: a response takes friction for damping, but the sign of the
/// velocity has harmonics that no smooth response makes of the force. On the lines of the excited band, block by block,
///
///     X = G F + T - F_c G e^{jwT/2} S,  G and T of second degree in the frequency
///
/// X, F, S: lines of the motion, of the force and of sign v, of a whole period's mean where the force repeats; T: what leaks
/// from the record's ends; F_c: one for all blocks, each weighted by what it leaves. A delay turns F_c by up to some 60 degrees.
/// Nothing where no recording has lines enough.
[[nodiscard]] std::optional<HiddenFriction> hidden_friction(std::span<const Recording> recordings,
                                                            std::span<const FrequencyResponse> responses,
                                                            const FrequencyResponseOptions& options);

/// The pooled response without this much friction: 1/G_0 = 1/G - F_c kappa jw/D, kappa: the regression of sign v on v, line by
/// line over those around it, averaged over the recordings by the power of their force; D: the hold.
[[nodiscard]] FrequencyResponse without_friction(const FrequencyResponse& response, double force,
                                                 std::span<const Recording> recordings,
                                                 const FrequencyResponseOptions& options);

}  // namespace zwidth::internal
