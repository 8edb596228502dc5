#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/drive_problem.hpp"
#include "zwidth/finding.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/rig/force_guard.hpp"
#include "zwidth/rig/nudge.hpp"

namespace zwidth {

/// What a rig's clock did, s; percentiles within 0.2 %.
struct LatencySummary {
  std::uint64_t count = 0;  ///< how many were measured
  double p50 = 0.0;         ///< s
  double p99 = 0.0;         ///< s
  double p999 = 0.0;        ///< 99.9 %
  double p9999 = 0.0;       ///< 99.99 %
  double max = 0.0;         ///< s
};

/// A duration, and how often it was measured.
struct DurationCount {
  double duration = 0.0;    ///< s, within 0.2 %
  std::uint64_t count = 0;  ///< cycles
};

/// How the cycles of a rig ran.
struct LoopTiming {
  std::uint64_t cycles = 0;      ///< of the loop
  std::uint64_t missed = 0;      ///< late by a period or more
  std::uint64_t unanswered = 0;  ///< without a position
  LatencySummary latency;        ///< from the instant of the clock to the cycle's begin; none in lock step
  LatencySummary period;         ///< from one begin to the next; none in lock step
  LatencySummary body;           ///< from a cycle's begin to its end
  /// From asking for the position to the last byte of the force having left on a serial line; none in lock step.
  LatencySummary delay;
  std::vector<DurationCount> delays;  ///< the same of all cycles, rising
};

/// What a drive says of itself. What is absent it does not tell.
struct DriveSettings {
  std::string firmware = {};                      ///< "6.05"; empty: it does not tell
  std::optional<double> force_limit = {};         ///< N or N m, of the drive itself
  std::optional<double> least_force = {};         ///< N or N m, below which it gives none
  std::optional<double> least_current = {};       ///< A, the same
  std::optional<double> tracking_bandwidth = {};  ///< rad/s, of the filter of its position (Sensor); 0: none
  bool is_filter_assumed = false;                 ///< by its firmware's default: it does not tell
  std::optional<double> position_lag = {};        ///< s, of a first-order filter of its position; 0: none
  std::optional<int> mode_after_watchdog = {};    ///< a moteus', by its number
  bool are_unknown = false;                       ///< it has settings of which nothing is known here
};

/// One session on a rig: what it ran on, how, and how it ended.
struct RigSession {
  std::string driver;                       ///< "simulated", "udp:127.0.0.1:7000", ...
  Motion motion = Motion::linear;           ///< of the device
  double began = 0.0;                       ///< s since 1970 in UTC; 0: not known
  bool lock_step = false;                   ///< the device's time moves with the cycles: as fast as they run
  double sampling_period = 0.0;             ///< s
  SafetyLimits limits;                      ///< beyond which the force went to zero
  std::optional<double> firmware_watchdog;  ///< s; absent: the firmware has none, or there is no firmware
  StopReason stop = StopReason::none;       ///< none: the work came to its end
  double stopped_at = 0.0;                  ///< s from the start
  std::optional<Nudge> nudge;               ///< before any wall; absent: none was given
  DriveSettings drive;                      ///< of the drive
  std::optional<DriveProblem> trouble;      ///< why there was no position, where the drive itself said so
  LoopTiming timing;                        ///< of clock and drive
  std::vector<Remark> remarks;              ///< what is worth knowing beside it
};

/// What a nudge that tells no sign, or the wrong one, says.
[[nodiscard]] Finding finding_of(const Nudge& nudge, Motion motion);

/// Why the force went to zero; nothing where it did not.
[[nodiscard]] std::optional<Finding> finding_of(const RigSession& session);

/// A sentence or two on why the force went to zero, and what to do; empty for none.
[[nodiscard]] std::string explanation(StopReason reason);

/// The same of a session: with what the drive itself said.
[[nodiscard]] std::string explanation(const RigSession& session);

}  // namespace zwidth
