#pragma once

#include "zwidth/rig/results.hpp"

namespace zwidth {

/// Whether a wall that ran is what was predicted of it: sets `grows`, and doubts in `trust`
///
/// - a wall that is unstable by linear analysis, with nobody or with the file's user, and was not taken away: an end without
///   alarm does not make it stable;
/// - one that is stable by linear analysis with both and oscillated or grew all the same;
/// - one under whose force the position never changed;
/// - one that did not run to its end, for the rig stopped;
/// - one that was felt softer than it is, for force was kept back.
///
/// An oscillation grows where its rate lies three standard errors above zero.
void judge(RigWall& wall);

/// Sets `trust` and `remarks`: those of the measurement, and whether the device bears what its file promises.
///
/// Where LimitMeasurement::at_most lies below the limit with nobody holding and, of a file with a user, below that with
/// its user, walls that the file calls stable grow on the device: a warning that begins with UNSAFE, and the prediction is
/// doubtful. Nothing but what the measurement is unsure of itself is allowed for. Where it lies below the limit with the
/// file's user alone, nobody may have held the device: a note. Where it lies a tenth or more from that limit, not surely below it,
/// a warning or a note says so with both numbers.
void judge(RigLimit& limit, const Device& device);

/// Adds to `remarks` why the session stopped, which share of its cycles brought no position and what that does to the limit, and
/// that the drive limits the force below the rig's limit.
///
/// A cycle without a position repeats the force of the one before: of a share p of them the force is older by p T in the
/// mean,
///
///     error = 1 - K_CR(t_d + p T) / K_CR(t_d)
///
/// of the device's file. Not said where that has no finite limit.
void remark(RigSession& session, const Device& device);

/// Refuses where the rig stopped and there is no response. Doubts a measured response whose limit is taken for a device with dry friction, by its file: to a linear estimate
/// friction is damping, which a wall at its limit has less of the larger the motion.
void judge(RigMeasurement& measurement, const Device& device);

}  // namespace zwidth
