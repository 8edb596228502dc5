#pragma once

#include "zwidth/rig/results.hpp"

namespace zwidth {

/// Whether a wall that ran is what was predicted of it: sets `grows`, and doubts in `trust`
///
/// - a wall that is unstable by linear analysis and was not taken away: an end without alarm does not make it stable;
/// - one that is stable by linear analysis and oscillated or grew all the same;
/// - one under whose force the position never changed;
/// - one that did not run to its end, for the rig stopped;
/// - one that was felt softer than it is, for force was kept back.
///
/// An oscillation grows where its rate lies three standard errors above zero.
void judge(RigWall& wall);

/// Refuses where the rig stopped and there is no response. Doubts a measured response whose limit is taken for a device with dry friction, by its file: to a linear estimate
/// friction is damping, which a wall at its limit has less of the larger the motion.
void judge(RigMeasurement& measurement, const Device& device);

}  // namespace zwidth
