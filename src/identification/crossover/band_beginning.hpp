#pragma once

#include <optional>
#include <span>

#include "identification/crossover/phase_lines.hpp"

namespace zwidth::internal {

/// How the response goes on from where the band begins, by least squares over its lowest lines.
struct Beginning {
  double steepness = 0.0;  ///< d ln |P| / d ln w: -1 to -2 of a rigid body
  double turning = 0.0;    ///< d arg P / d ln w, rad
};

/// Of the lines up to 1.5 times the lowest frequency. Nothing where fewer than four are measured.
[[nodiscard]] std::optional<Beginning> beginning_of(std::span<const PhaseLine> lines);

/// The phase where the band begins, degrees, of a position that falls as the force rises: half a turn off the -90 to -180
/// degrees that belong to how steeply the response falls there (Bode). Nothing where it is not, where the response does
/// not fall as a mass's does, or where a delay turns the phase.
[[nodiscard]] std::optional<double> turned_phase(std::span<const PhaseLine> lines);

}  // namespace zwidth::internal
