#pragma once

#include <optional>

#include "zwidth/identification/identification.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::internal {

/// Doubts an answer otherwise sound where a crossover beyond the lines may limit by more than 10 % below the interval:
/// with one number that the data hardly show at either end of its 95 % interval, the others fitted anew and explaining the
/// response as well (a mode just above the band, whose damping is a guess), with a mode at the fitted place, or elsewhere above
/// the band, that is damped by 0.1 % of the critical damping; or in one of 24 fits that begin with other values of what the data do not
/// show and explain the response as well. Within the band the response itself says that there is none. `as_fitted`: the
/// device with all that the fit leaves open, of which the response may have narrowed result's.
///
/// Returns another device near which the same numbers explain the record by so much more that the answer's cannot be the
/// device's, where these searches come to one: the answer's had ended beside it.
[[nodiscard]] std::optional<Device> judge_unseen_limit(Identification& result, const Device& as_fitted,
                                                       const IdentifyOptions& options);

}  // namespace zwidth::internal
