#pragma once

namespace zwidth::internal {

// What 95 % of chance is within.
inline constexpr double deviations_of_95 = 1.96;   ///< of a normal distribution, either way
inline constexpr double chi_squared_of_95 = 3.84;  ///< with one degree of freedom
inline constexpr double rise_of_95 = 1.92;         ///< of minus the log-likelihood: half of that

}  // namespace zwidth::internal
