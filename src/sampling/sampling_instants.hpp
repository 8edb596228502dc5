#pragma once

#include <cstddef>

#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// t_d = (l + f) T: within each period the device first feels u[k-l-1] for f T, then u[k-l] for (1 - f) T.
struct SamplingInstants {
  std::size_t whole_samples = 0;  // l
  double with_new = 0.0;          // (1 - f) T
  double with_old = 0.0;          // f T; 0 for a whole number of samples
};

// Throws Error (invalid_argument) unless period > 0 and delay >= 0, both finite.
SamplingInstants sampling_instants(const Sampling& sampling);

}  // namespace zwidth::internal
