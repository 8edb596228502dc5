#pragma once

// What a sampled plant keeps of its terms in double-double.

#include <cstddef>
#include <vector>

#include "sampling/extended_sampling.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// In double-double, or where crowded poles are beyond it sample_exactly().
[[nodiscard]] ExtendedTerm sample_precisely(const ModalTerm& term, const SamplingInstants& instants);

// The coefficients in double, and what rounding left out of them. The degree stands.
void round_into(const ExtendedTerm& term, SampledTerm& sampled);

// Products of a few terms must stay in range: an unstable pole may grow that much within one period. Throws Error
// (did_not_converge).
void check_range(const SampledTerm& sampled);

// The terms' cancellation where it is worst, far above the modes.
[[nodiscard]] double worst_cancellation(const SampledPlant& plant);
// The same near the poles of each term.
[[nodiscard]] double cancellation_at_poles(const SampledPlant& plant);
// The same at z = -1, for the coefficients within each numerator: a slow device's response nearly vanishes there.
[[nodiscard]] double cancellation_at_nyquist(const SampledPlant& plant);

// 1e-16 times this is what a stiffness at Nyquist may lose.
inline constexpr double tolerable_cancellation_at_nyquist = 1e5;
// The common numerator of more terms cancels in double, by powers of two.
inline constexpr std::size_t rounded_terms = 6;
// Beyond this loss the numerators are added up in double-double instead.
inline constexpr double tolerable_cancellation = 1e3;
// And beyond this one, near the poles, as one polynomial.
inline constexpr double carried_cancellation = 1e7;

// Adds the numerators up in double-double.
void add_up(const std::vector<ExtendedTerm>& terms, bool keeps_rests, SampledPlant& plant);

// All coefficients of a plant whose terms have their degrees, rests and sums included: as closely as they are known.
void fill_in(const std::vector<ExtendedTerm>& terms, SampledPlant& plant);

}  // namespace zwidth::internal
