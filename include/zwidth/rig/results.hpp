#pragma once

#include <optional>

#include "zwidth/control/sampled_controller.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/measured_response.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/rig/limit_search.hpp"
#include "zwidth/rig/session.hpp"
#include "zwidth/simulation/relay.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/trust.hpp"

// What the actions on a rig find, beside the session in which they did.

namespace zwidth {

struct RigCheck {
  RigSession session;
  /// Silence made the firmware let go. Absent: there is no firmware, or none that watches.
  std::optional<bool> watchdog_proved;
};

struct RigMeasurement {
  RigSession session;
  Excitation excitation;
  Recording recording;                       ///< force and position; empty where the rig stopped
  std::optional<MeasuredResponse> response;  ///< absent where the rig stopped
};

struct RigIdentification {
  RigMeasurement measurement;
  std::optional<Identification> identification;  ///< absent where the rig stopped
};

struct RigRelay {
  RigSession session;
  std::optional<RelayResult> relay;  ///< absent where the rig stopped in the first trial
};

struct RigWall {
  RigSession session;
  ControllerOptions controller;
  CriticalStiffness predicted;  ///< with the wall's damper and filters
  Trust trust;                  ///< of the prediction
  std::optional<bool> predicted_stable;
  bool oscillates = false;       ///< it grew, and the wall was taken away
  std::optional<RingDown> ring;  ///< the oscillation at the end, where one is left
  double peak_force = 0.0;       ///< N or N m
  double peak_position = 0.0;    ///< m or rad, from the start
};

struct RigLimit {
  RigSession session;
  LimitMeasurement measured;
  CriticalStiffness predicted;
  std::optional<AnyUserLimit> any_user;
  double knock = 0.0;  ///< N or N m
};

}  // namespace zwidth
