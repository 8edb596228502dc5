#pragma once

#include <optional>
#include <span>

#include "identification/phase_lines.hpp"

namespace zwidth::internal {

/// How the response goes on from where the band begins, by least squares over its lowest lines.
struct Beginning {
  double steepness = 0.0;  ///< d ln |P| / d ln w: -1 to -2 of a rigid body
  double turning = 0.0;    ///< d arg P / d ln w, rad
};

/// Of the lines up to 1.5 times the lowest frequency. Nothing where fewer than four are measured.
[[nodiscard]] std::optional<Beginning> beginning_of(std::span<const PhaseLine> lines);

}  // namespace zwidth::internal
