#pragma once

#include <cstddef>
#include <vector>

#include "rig/driver.hpp"
#include "rig/rig_actions.hpp"
#include "rig/rig_run.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/rig/session.hpp"
#include "zwidth/signal/recording.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::rig {

/// At least one.
[[nodiscard]] std::size_t cycles_of(double duration, const Device& device);

/// rad/s, of the predicted limit; 10 Hz where theory has no frequency.
[[nodiscard]] double frequency_of(const CriticalStiffness& predicted);

[[nodiscard]] Recording recording_of(Played played, const Device& device, const Driver& driver);

/// Ends the session, and hands its record over.
RigSession ended(RigRun& run, const RigOptions& options, StopReason otherwise = StopReason::none);

[[nodiscard]] double part(std::size_t done, std::size_t all);
void report(const Progress& progress, double done);

/// By its magnitude.
[[nodiscard]] double largest(const std::vector<double>& values);

}  // namespace zwidth::rig
