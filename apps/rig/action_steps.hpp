#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rig/driver.hpp"
#include "rig/rig_actions.hpp"
#include "rig/rig_run.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/rig/nudge.hpp"
#include "zwidth/rig/session.hpp"
#include "zwidth/signal/recording.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::rig {

/// What the sign of a drive is needed for.
enum class SignNeed { for_wall, to_be_told };  // for_wall: no wall where it is not known

/// At least one.
[[nodiscard]] std::size_t cycles_of(double duration, const Device& device);

/// rad/s, of the predicted limit; 10 Hz where theory has no frequency.
[[nodiscard]] double frequency_of(const CriticalStiffness& predicted);

[[nodiscard]] Recording recording_of(Played played, const Device& device, const Driver& driver);

/// What a session was about: the device, and the nudge that it began with.
struct SessionStart {
  Device device;
  std::optional<Nudge> nudge = {};
};

/// How a device is nudged.
struct NudgeRequest {
  double damping = 0.0;                   ///< of the damper that the drive closes, N s/m or N m s/rad
  std::optional<double> most_force = {};  ///< of the action that follows, N or N m: a nudge is no harder
  SignNeed need = SignNeed::for_wall;
};

/// Nudges the device with a growing force, up to default_force(), until the drive's sign is known; stops the rig where it is
/// wrong, and where no wall may run without it. No nudge of a simulated device, whose sign is known, and where none is
/// wanted.
[[nodiscard]] SessionStart nudged(RigRun& run, const Device& device, const Driver& driver, const RigOptions& options,
                                  const NudgeRequest& request);

/// Ends the session, and hands its record over.
RigSession ended(RigRun& run, const SessionStart& start, const RigOptions& options,
                 StopReason otherwise = StopReason::none);

[[nodiscard]] double part(std::size_t done, std::size_t all);
void report(const Progress& progress, double done);

/// By its magnitude.
[[nodiscard]] double largest(const std::vector<double>& values);

}  // namespace zwidth::rig
