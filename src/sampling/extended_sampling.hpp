#pragma once

#include <vector>

#include "model/extended_precision.hpp"
#include "sampling/sampling_instants.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// A sampled term in double-double: polynomials in delta, ascending; the denominator with its leading 1.
struct ExtendedTerm {
  std::vector<Extended> numerator;
  std::vector<Extended> denominator;
};

// Samples a term of any degree: matrix exponential of the companion form and Faddeev-LeVerrier, in double-double. With
// a fractional delay the numerator stands over one sample of delay more, as in sample().
ExtendedTerm sample_extended(const ModalTerm& term, const SamplingInstants& instants);

// P(-1), the delay included; 0 where it vanishes to rounding.
double response_at_nyquist(const std::vector<ExtendedTerm>& terms, std::size_t delay_samples);

// sum_k N_k prod_{j != k} D_j, and the same rounded.
std::vector<Extended> extended_common_numerator(const std::vector<ExtendedTerm>& terms);
std::vector<double> common_numerator(const std::vector<ExtendedTerm>& terms);

}  // namespace zwidth::internal
