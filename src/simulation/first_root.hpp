#pragma once

#include <span>

namespace zwidth::internal {

/// The first s in [0, 1] where the polynomial sum_k coefficients[k] s^k, not negative at 0, turns negative; 2 where it
/// never does. At most 32 coefficients.
///
/// Complete: an interval is dismissed only where all Bernstein coefficients are >= 0, and searched by halving otherwise
/// (a root is polished where exactly one change of sign is left).
[[nodiscard]] double first_turn_negative(std::span<const double> coefficients) noexcept;

}  // namespace zwidth::internal
