#pragma once

#include <cstddef>

#include "zwidth/model/device.hpp"
#include "zwidth/model/state_space.hpp"

namespace zwidth {

inline constexpr std::size_t max_exact_states = 40;  ///< of transfer_function()

/// The transfer function of a state space, computed without rounding; each coefficient is rounded once.
///
///     G(s) = C adj(s I - A) B / det(s I - A)
///
/// What rounding of A, B and C alone may have made is 0: the lowest coefficients of the denominator, so that a rigid
/// body's pole is at s = 0 and not beside it, where it might grow, and the highest of the numerator.
/// Throws Error (invalid_argument) for shapes that do not fit, no states or more than max_exact_states, and entries
/// that are not finite or beyond 1e-100..1e100 in magnitude.
/// Faddeev and LeVerrier's recursion: F. R. Gantmacher, The Theory of Matrices, vol. 1 (1959), ch. IV, sec. 5.
[[nodiscard]] TransferFunction transfer_function(const ContinuousStateSpace& system);

}  // namespace zwidth
