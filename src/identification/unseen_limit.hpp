#pragma once

#include "zwidth/identification/identification.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::internal {

/// Doubts an answer otherwise sound where one number that the data hardly show, moved to either end of its 95 % interval
/// and the others with it, lets a crossover beyond the lines limit by more than 10 % below the interval: a mode just
/// above the band, whose damping is a guess. Within the band the response itself says that there is none.
void judge_unseen_limit(Identification& result, const IdentifyOptions& options, Trust device_trust);

}  // namespace zwidth::internal
