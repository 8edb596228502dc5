#pragma once

#include <cstddef>

#include "sampling/extended_sampling.hpp"

namespace zwidth::internal {

// A term of a fast loop, behind an input that changes only every `steps` of its samples, as it is seen that often:
//
//     x[k+1] = A x[k] + b u[k - late],  y[k] = c x[k]     ->     z = (z of the fast loop)^steps
//
//     c (zI - A^steps)^-1 (sum_{i < steps - late} A^i b + z^-1 A^(steps - late) sum_{i < late} A^i b)
//
// `late` < steps; where it is not 0 the numerator stands over one slow sample of delay more, as in sample_extended(). The
// first `integrators` coefficients of the denominator are 0 before and after.
ExtendedTerm decimated(const ExtendedTerm& fast, std::size_t integrators, std::size_t steps, std::size_t late);

}  // namespace zwidth::internal
