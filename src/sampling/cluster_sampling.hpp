#pragma once

#include "sampling/sampling_instants.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth {

// Samples a term of any degree (poles that nearly coincide): matrix exponential of the companion form and
// Faddeev-LeVerrier, in double-double.
void sample_cluster(const ModalTerm& term, const SamplingInstants& instants, SampledTerm& sampled);

}  // namespace zwidth
