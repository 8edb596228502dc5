#pragma once

#include "sampling/extended_sampling.hpp"

namespace zwidth::internal {

// sample_extended() in balls whose precision rises until every coefficient is known to double-double: for terms of
// crowded poles, whose polynomials double-double cannot follow. Throws Error (did_not_converge) where none suffices.
ExtendedTerm sample_exactly(const ModalTerm& term, const SamplingInstants& instants);

}  // namespace zwidth::internal
