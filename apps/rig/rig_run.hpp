#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "rig/driver.hpp"
#include "rig/rig_loop.hpp"
#include "zwidth/rig/session.hpp"

namespace zwidth::rig {

/// While it lives, SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGTSTP stop the rig instead of the program.
class InterruptsStopRigs {
 public:
  InterruptsStopRigs();
  ~InterruptsStopRigs();
  InterruptsStopRigs(const InterruptsStopRigs&) = delete;
  InterruptsStopRigs& operator=(const InterruptsStopRigs&) = delete;
};

/// Told about ten times a second what the loop does, by the thread that waits for it: never by the loop's own.
using Watcher = std::function<void(const LiveState&)>;

/// A session on a drive: arms it, runs the loop, and whatever happens leaves it with zero force.
///
/// In lock step cycles run in play(); else in a thread of their own on the clock, with a watchdog beside it: one that
/// stands still for longer than the cycles that may be missed has its drive disarmed by the watchdog.
class RigRun {
 public:
  /// Throws DriverFailed, and Error where find_problem(limits) finds one.
  RigRun(Driver& driver, const SafetyLimits& limits, double sampling_period, Watcher watcher = {});
  RigRun(const RigRun&) = delete;
  RigRun& operator=(const RigRun&) = delete;
  ~RigRun();

  /// Runs a segment to its end, or until the rig stops.
  [[nodiscard]] Played play(const Segment& segment);
  /// Stops the rig: zero force from the next cycle on.
  void stop(StopReason reason);
  [[nodiscard]] bool is_stopped() const noexcept { return loop_.stopped() != StopReason::none; }
  /// Ends the session: zero force. What it was, then.
  [[nodiscard]] RigSession end();
  /// After end().
  [[nodiscard]] const FlightRecorder& recorder() const noexcept { return loop_.recorder(); }

 private:
  void run_on_clock() noexcept;
  void watch() noexcept;
  void halt() noexcept;
  void tell_watcher() noexcept;

  Driver& driver_;
  SafetyLimits limits_;
  double period_;
  std::chrono::system_clock::time_point began_ = std::chrono::system_clock::now();
  RigLoop loop_;
  Watcher watcher_;
  std::chrono::steady_clock::time_point told_;
  std::optional<InterruptsStopRigs> interrupts_{std::in_place};  // until the force is zero
  std::vector<Remark> remarks_;
  std::vector<Remark> thread_remarks_;
  std::atomic<bool> is_ending_ = false;
  std::atomic<bool> has_prepared_ = false;
  std::atomic<bool> has_barked_ = false;
  std::thread clock_;
  std::thread watchdog_;
};

}  // namespace zwidth::rig
