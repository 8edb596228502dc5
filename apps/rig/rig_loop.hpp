#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rig/driver.hpp"
#include "rig/flight_recorder.hpp"
#include "rig/latency_histogram.hpp"
#include "rig/live_state.hpp"
#include "zwidth/control/sampled_controller.hpp"
#include "zwidth/rig/force_guard.hpp"
#include "zwidth/rig/oscillation_watch.hpp"

namespace zwidth::rig {

/// A stretch of work of the loop: a controller, and a force beside it.
struct Segment {
  ControllerOptions controller = {};  ///< about the position at the session's start
  std::vector<double> force = {};     ///< added to it, cycle by cycle; zero after its end
  std::size_t cycles = 0;
  std::vector<double> watched = {};  ///< rad/s, where an oscillation that grows ends it; empty: none is looked for
  double watch_floor = 0.0;          ///< m or rad
  std::size_t watch_from = 0;        ///< cycle
  std::size_t cut_from = 0;          ///< cycle from which force that is kept back counts
  bool ramps = false;                ///< the force grows from zero at its start
};

/// What a segment did. Positions are from the session's start.
struct Played {
  std::vector<double> force;           ///< sent, N or N m
  std::vector<double> position;        ///< m or rad
  StopReason stop = StopReason::none;  ///< oscillation: this segment alone ended early
  std::size_t cut = 0;                 ///< cycles from `cut_from` on in which less force was sent than wanted
};

/// A segment ready to run: all that it needs is there.
class RunningSegment {
 public:
  RunningSegment(const Segment& segment, double sampling_period);

  /// The force wanted for a position, from the session's start, of which there is none where the link failed.
  [[nodiscard]] double update(double position) noexcept;
  /// What was sent for it. True: the segment is over.
  bool sent(double force, std::optional<double> position) noexcept;
  void stop(StopReason reason) noexcept { stop_ = reason; }
  /// The wall and its oscillation, as they are now.
  void show(LiveState& state) const noexcept;

  /// The force has to grow from zero, from this cycle on.
  [[nodiscard]] bool begins_ramp() const noexcept { return ramps_ && cycle_ == 0; }
  /// What it did; empties it.
  [[nodiscard]] Played played();

 private:
  SampledController controller_;
  OscillationWatch watch_;
  std::vector<double> added_;
  std::vector<double> force_;
  std::vector<double> position_;
  std::size_t watch_from_;
  std::size_t cut_from_;
  bool ramps_;
  double stiffness_;
  double damping_;
  std::size_t cycle_ = 0;
  double last_position_ = 0.0;
  double wanted_ = 0.0;
  std::size_t cut_ = 0;
  StopReason stop_ = StopReason::none;
};

/// The body of the loop, the same in lock step and in real time: position, controller, limits, force, record.
///
/// cycle() allocates, locks, logs and throws nothing.
class RigLoop {
 public:
  RigLoop(Driver& driver, const SafetyLimits& limits, double sampling_period);

  /// One cycle at `now` ns of a clock, due at `due`; lock step has no clock but the cycles: both 0.
  void cycle(std::int64_t now, std::int64_t due) noexcept;

  /// Hands a segment over to the next cycle. It stays the caller's, who waits for is_idle().
  void play(RunningSegment* segment) noexcept { segment_.store(segment, std::memory_order_release); }
  [[nodiscard]] bool is_idle() const noexcept { return segment_.load(std::memory_order_acquire) == nullptr; }
  /// From any thread.
  void request_stop(StopReason reason) noexcept;

  [[nodiscard]] StopReason stopped() const noexcept { return stopped_.load(std::memory_order_acquire); }
  [[nodiscard]] std::uint64_t cycles() const noexcept { return cycles_.load(std::memory_order_relaxed); }
  [[nodiscard]] bool has_clock() const noexcept { return has_clock_; }
  /// What it does now; from any thread.
  [[nodiscard]] LiveState look() const noexcept { return board_.look(); }
  /// When the loop does not run.
  [[nodiscard]] const FlightRecorder& recorder() const noexcept { return recorder_; }
  [[nodiscard]] LoopTiming timing() const;
  [[nodiscard]] double stopped_at() const noexcept { return stopped_at_; }

 private:
  void finish(RunningSegment* segment) noexcept;

  Driver& driver_;
  double period_;
  std::int64_t period_ns_;
  bool has_clock_;
  std::int64_t wire_ns_;  // that a force takes after it was handed to the line
  ForceGuard guard_;
  FlightRecorder recorder_;
  LiveBoard board_;
  LatencyHistogram latency_;
  LatencyHistogram between_;
  LatencyHistogram body_;
  LatencyHistogram delay_;
  std::atomic<RunningSegment*> segment_ = nullptr;
  std::atomic<StopReason> request_ = StopReason::none;
  std::atomic<StopReason> stopped_ = StopReason::none;
  std::atomic<std::uint64_t> cycles_ = 0;
  std::int64_t previous_ = 0;
  std::int64_t first_ = 0;
  bool has_origin_ = false;
  double origin_ = 0.0;
  std::uint64_t missed_ = 0;
  std::uint64_t unanswered_ = 0;
  double stopped_at_ = 0.0;
};

}  // namespace zwidth::rig
