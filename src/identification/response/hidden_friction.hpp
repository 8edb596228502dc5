#pragma once

#include <optional>
#include <span>

#include "zwidth/identification/measured_response.hpp"

namespace zwidth::internal {

/// An opposing force of the sensed body that no linear device has.
struct HiddenForce {
  double size = 0.0;       ///< >= 0
  double deviation = 0.0;  ///< one standard deviation of it

  /// What is found of it falls short: the sign of a sampled velocity turns late, and a body that sticks has none. Looked at
  /// on about 6 records of the identification campaign's seeds 1 to 5, on which the factor was set too: 8 to 27 % too little.
  static constexpr double most_found = 1.3;
  [[nodiscard]] double most() const { return most_found * size + deviation; }
  /// Beyond chance: of 585 sound responses of linear devices (docs/identification_tests.md) 8 show friction or drag.
  [[nodiscard]] bool shows() const {
    constexpr double clear = 3.5;  // deviations
    return size > clear * deviation;
  }
};

/// F_c sign v + D v|v|.
struct HiddenForces {
  HiddenForce friction;  ///< N or N m
  HiddenForce drag;      ///< N s^2/m^2 or N m s^2
};

/// The friction and the drag that recordings show beside their smooth responses: a response takes them for damping, but they
/// have harmonics that no smooth response makes of the force. On the lines of the excited band, block by block,
///
///     X = G F + T - G (F_c S + D Q),  w^2 G and T of second degree in the frequency
///
/// X, F, S, Q: lines of the motion, the force, the means of sign v and v|v| between samples; where the force repeats, of a whole
/// period's mean; T: what leaks from the record's ends; F_c and D: one for all blocks, each weighted by what it leaves. A delay
/// turns them by up to some 60 degrees. Nothing where no recording has lines enough.
[[nodiscard]] std::optional<HiddenForces> hidden_forces(std::span<const Recording> recordings,
                                                        std::span<const FrequencyResponse> responses,
                                                        const FrequencyResponseOptions& options);

/// The pooled response without these (their sizes): 1/G_0 = 1/G - kappa jw/D_h, kappa: the regression of the forces on v, line
/// by line over those around it, averaged over the recordings by the power of their force; D_h: the hold.
[[nodiscard]] FrequencyResponse without_forces(const FrequencyResponse& response, const HiddenForces& forces,
                                               std::span<const Recording> recordings,
                                               const FrequencyResponseOptions& options);

}  // namespace zwidth::internal
