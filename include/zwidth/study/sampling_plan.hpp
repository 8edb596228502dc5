#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "zwidth/option_problem.hpp"

namespace zwidth {

/// How the units are spread over what may vary.
enum class SamplingScheme {
  random,           ///< independent: intervals of yield and quantiles hold exactly
  latin_hypercube,  ///< every parameter falls once into each of N equal shares
  sobol,            ///< Sobol's points, scrambled
};

inline constexpr std::size_t most_study_parameters = 200;                     ///< that vary together
inline constexpr std::uint64_t most_study_samples = 1'000'000'000'000;        ///< of one study
inline constexpr std::uint64_t most_sobol_samples = std::uint64_t{1} << 32U;  ///< of the sequence's 32 bits

/// Uniform numbers of `samples` samples in `dimensions`: the i-th depends on the plan and i alone, whoever computes it.
///
/// random: Philox 4x32-10 (J. K. Salmon et al., SC 2011). latin_hypercube: a keyed permutation of 0..N-1 per dimension
/// (four rounds of Feistel's network over Philox, walked until it falls into the range), and a random place within the
/// share. sobol: direction numbers of S. Joe and F. Y. Kuo, SIAM J. Sci. Comput. 30, 2635 (2008), as in Boost.Random,
/// scrambled by a hash of nested bits (B. Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020), and
/// a random place within the last of 32 bits.
class SamplingPlan {
 public:
  /// Throws Error (invalid_argument) where find_problem() finds one.
  SamplingPlan(SamplingScheme sampling, std::uint64_t samples, std::size_t dimensions, std::uint64_t seed);

  /// In least_uniform..1 - least_uniform, for i < samples, dimension < dimensions.
  [[nodiscard]] double uniform(std::uint64_t i, std::size_t dimension) const;

  /// The first argument outside its domain.
  [[nodiscard]] static std::optional<OptionProblem> find_problem(SamplingScheme sampling, std::uint64_t samples,
                                                                 std::size_t dimensions);

 private:
  [[nodiscard]] std::uint64_t permuted(std::uint64_t i, std::size_t dimension) const;
  [[nodiscard]] std::uint32_t scrambled(std::uint64_t i, std::size_t dimension) const;

  SamplingScheme sampling_;
  std::uint64_t samples_;
  std::uint64_t seed_;
  std::uint32_t half_bits_ = 0;                            // of the Feistel network
  std::vector<std::array<std::uint32_t, 32>> directions_;  // of Sobol's points, by dimension
  std::vector<std::uint32_t> scrambles_;
};

}  // namespace zwidth
