#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace zwidth {

/// How much of the variance of an answer comes from one parameter.
struct SobolIndex {
  double first = 0.0;        ///< from it alone
  double first_error = 0.0;  ///< standard error, as if the points were random: Sobol's are better
  double total = 0.0;        ///< from it and from what it does together with others
  double total_error = 0.0;  ///< standard error
};

/// Answers of many points: columns of uniform numbers in, one per parameter, all of one size.
using ManyAnswers = std::function<std::vector<double>(const std::vector<std::vector<double>>& uniforms)>;

inline constexpr std::size_t most_index_dimensions = 100;  ///< of one call

/// First-order and total indices of Sobol, from two sets A and B of scrambled Sobol points, and for every parameter the
/// set A with its column of B; (dimensions + 2) `samples` answers in all:
///
///     S_i = mean(f(B) (f(AB_i) - f(A))) / V,    T_i = mean((f(A) - f(AB_i))²) / (2 V),    V the variance of f(A), f(B)
///
/// Zero where the answer varies by no more than rounding. Throws Error (invalid_argument) for no dimension, more than
/// most_index_dimensions, less than 2 samples, and answers that are not finite.
/// Sources: A. Saltelli et al., Comput. Phys. Commun. 181, 259 (2010), table 2; M. J. W. Jansen, ibid. 117, 35 (1999).
[[nodiscard]] std::vector<SobolIndex> sobol_indices(std::size_t dimensions, std::uint64_t samples, std::uint64_t seed,
                                                    const ManyAnswers& answers);

}  // namespace zwidth
