#pragma once

#include <span>

#include "zwidth/identification/identification.hpp"
#include "zwidth/signal/recording.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::internal {

/// Doubts a sound answer whose damping is friction, or may be.
///
/// Fits the motion of the device with friction of its heaviest body to each recording, then of the next, until one shows; from
/// the linear fit on, as identify_in_time() does, and to the first part of a recording that takes long to play, to the whole
/// where the part leaves friction open that matters. It finds what find_friction() does not: friction that is no small
/// disturbance of the linear fit's motion, as where a body drifts until friction stops it, or where modes above the band are
/// not known. Doubtful:
///
/// - the friction shows, by 4.8 deviations;
/// - one of more than two deviations would make the critical stiffness 5 % lower, and lower than its interval; 4 %, and lower
///   than the middle of the interval's lower part, where it explains the record clearly (by 8 of the log-likelihood);
/// - one that explains the record clearly puts it more than 1 % below its interval;
/// - one of any size that explains it about as well as none puts it more than 10 % below: the best one, or up to two
///   deviations more.
///
/// A friction of two deviations that leaves it within the interval is a note.
void judge_friction_in_time(Identification& result, std::span<const Recording> recordings,
                            const IdentifyOptions& options);

}  // namespace zwidth::internal
