#pragma once

#include <optional>
#include <vector>

#include "zwidth/control/sampled_controller.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/measured_response.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/rig/limit_search.hpp"
#include "zwidth/rig/session.hpp"
#include "zwidth/simulation/relay.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/holding.hpp"
#include "zwidth/trust.hpp"

// What the actions on a rig find, beside the session in which they did.

namespace zwidth {

/// The loop at rest: link, rate, watchdog, latency.
struct RigCheck {
  RigSession session;  ///< what ran
  /// Silence made the firmware let go. Absent: there is no firmware, or none that watches.
  std::optional<bool> watchdog_proved;
  Trust trust;  ///< of the device's file
};

/// A record of the device under excitation.
struct RigMeasurement {
  RigSession session;                        ///< what ran
  Excitation excitation;                     ///< what was commanded
  Recording recording;                       ///< force and position; empty where the rig stopped
  std::optional<MeasuredResponse> response;  ///< absent where the rig stopped
  Trust trust;                               ///< of the device's file, and of the response
};

/// The device as fitted to a record of its own.
struct RigIdentification {
  RigMeasurement measurement;                    ///< what was fitted
  std::optional<Identification> identification;  ///< absent where the rig stopped
  Trust trust;                                   ///< of the device's file that ran, and of what was identified
};

/// The relay experiment on the device.
struct RigRelay {
  RigSession session;                ///< what ran
  std::optional<RelayResult> relay;  ///< absent where the rig stopped in the first trial
  Trust trust;                       ///< of the device's file, and of what was measured
};

/// A wall that was rendered.
struct RigWall {
  RigSession session;                    ///< what ran
  ControllerOptions controller;          ///< the wall as it ran, spring and damper
  bool damper_on_drive = false;          ///< the drive closed the damper; forces are those of the host, the spring's
  CriticalStiffness predicted;           ///< with the file's user, the wall's damper and filters
  HoldingLimits limits;                  ///< from the device's file, with this wall; who holds the rig is not known
  Trust trust;                           ///< in the wall: in the prediction, and whether what ran bears it out
  std::optional<StableFor> stable_for;   ///< absent where theory has no sure answer
  std::optional<bool> predicted_stable;  ///< with nobody and with the file's user; absent as that is
  bool oscillates = false;               ///< it grew, and the wall was taken away
  std::optional<RingDown> ring;          ///< the oscillation at the end, where one is left
  bool grows = false;                    ///< that one grows for sure
  double cut_duration = 0.0;             ///< s, for which force was kept back by its limit or by the ramp
  double peak_force = 0.0;               ///< N or N m
  double peak_position = 0.0;            ///< m or rad, from the start
  Recording recording;                   ///< force and position, from the first cycle
};

/// Where walls become unstable: measured, and predicted.
struct RigLimit {
  RigSession session;           ///< what ran
  LimitMeasurement measured;    ///< on the device
  CriticalStiffness predicted;  ///< from the device's file, with its user
  HoldingLimits limits;         ///< from the device's file: with nobody, its user and any passive user
  std::optional<AbsoluteStabilityLimit> any_user;  ///< absent where nobody can hold the device
  double impulse = 0.0;                            ///< N or N m
  Trust trust;                                     ///< of what was measured, and whether it bears out the prediction
  std::vector<Remark> remarks;                     ///< UNSAFE where the device bears less than its file promises
};

}  // namespace zwidth
