#include "rig/rig_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rig/real_time.hpp"

namespace zwidth::rig {
namespace {

constexpr double not_there = std::numeric_limits<double>::quiet_NaN();

/// ns, of a force's bytes and frames: the system takes them at once, the line and the bus one after the other.
std::int64_t time_on_wire(const DriverFacts& facts) {
  const double line = facts.byte_rate ? facts.force_bytes / *facts.byte_rate : 0.0;
  return std::llround(1e9 * (line + facts.force_bus_time));
}

}  // namespace

RunningSegment::RunningSegment(const Segment& segment, double sampling_period)
    : controller_(segment.controller, sampling_period),
      watch_(segment.watched, sampling_period, segment.watch_floor),
      added_(segment.force),
      force_(segment.cycles),
      position_(segment.cycles),
      watch_from_(segment.watch_from),
      cut_from_(segment.cut_from),
      ramps_(segment.ramps),
      stiffness_(segment.controller.kind == ControllerOptions::Kind::wall ? segment.controller.stiffness : 0.0),
      damping_(segment.controller.kind == ControllerOptions::Kind::wall ? segment.controller.damping : 0.0) {
  added_.resize(segment.cycles, 0.0);
}

double RunningSegment::update(double position) noexcept {
  return wanted_ = controller_.update(position) + added_[cycle_];
}

bool RunningSegment::sent(double force, std::optional<double> position) noexcept {
  if (position && std::isfinite(*position)) last_position_ = *position;
  force_[cycle_] = force;
  position_[cycle_] = last_position_;
  const bool is_cut = position && stop_ == StopReason::none && std::abs(force) < std::abs(wanted_);
  if (is_cut && cycle_ >= cut_from_) ++cut_;
  if (cycle_ >= watch_from_ && watch_.update(last_position_)) stop_ = StopReason::oscillation;
  ++cycle_;
  return cycle_ == force_.size() || stop_ != StopReason::none;
}

void RunningSegment::show(LiveState& state) const noexcept {
  state.stiffness = stiffness_;
  state.damping = damping_;
  state.swing = watch_.strongest();
}

Played RunningSegment::played() {
  force_.resize(cycle_);
  position_.resize(cycle_);
  return {std::move(force_), std::move(position_), stop_, cut_};
}

RigLoop::RigLoop(Driver& driver, const SafetyLimits& limits, double sampling_period)
    : driver_(driver),
      period_(sampling_period),
      period_ns_(std::llround(1e9 * sampling_period)),
      has_clock_(!driver.facts().lock_step),
      wire_ns_(time_on_wire(driver.facts())),
      guard_(limits, sampling_period),
      recorder_(sampling_period),
      has_origin_(driver.facts().is_zeroed) {}

void RigLoop::request_stop(StopReason reason) noexcept {
  StopReason none = StopReason::none;
  request_.compare_exchange_strong(none, reason, std::memory_order_acq_rel);
}

void RigLoop::finish(RunningSegment* segment) noexcept {
  if (segment != nullptr) segment_.store(nullptr, std::memory_order_release);
}

void RigLoop::cycle(std::int64_t now, std::int64_t due) noexcept {
  const std::uint64_t count = cycles_.load(std::memory_order_relaxed);
  const std::int64_t late = now - due;
  const std::int64_t begin = has_clock_ ? now : clock_now();
  if (count == 0) first_ = due;
  if (has_clock_) {
    latency_.add(late);
    if (count > 0) between_.add(now - previous_);
    const auto missed = static_cast<unsigned>(late / period_ns_);
    missed_ += missed;
    guard_.missed(missed);
  }
  previous_ = now;
  if (const StopReason wish = request_.load(std::memory_order_acquire); wish != StopReason::none) guard_.stop(wish);

  RunningSegment* const segment = segment_.load(std::memory_order_acquire);
  if (segment != nullptr && segment->begins_ramp()) guard_.restart();
  const std::optional<double> position = driver_.measure();
  double wanted = 0.0;
  double force = 0.0;
  if (!position) {
    ++unanswered_;
    force = guard_.no_position();
  } else {
    if (!has_origin_ && std::isfinite(*position)) {
      has_origin_ = true;
      origin_ = *position;
    }
    wanted = segment != nullptr && guard_.stopped() == StopReason::none ? segment->update(*position - origin_) : 0.0;
    force = guard_.update(*position, wanted);
  }
  driver_.command(force);
  const StopReason stop = guard_.stopped();
  const double time = has_clock_ ? 1e-9 * static_cast<double>(now - first_) : static_cast<double>(count) * period_;
  recorder_.put({time, has_clock_ ? 1e-9 * static_cast<double>(late) : 0.0, position.value_or(not_there),
                 guard_.velocity(), wanted, force, static_cast<double>(stop)});
  if (stop != StopReason::none && stopped_.load(std::memory_order_relaxed) == StopReason::none) {
    stopped_at_ = time;
    stopped_.store(stop, std::memory_order_release);
  }
  LiveState live;
  live.time = time;
  live.position = position.value_or(origin_) - origin_;
  live.force = force;
  live.worst = body_.max();
  if (segment != nullptr) {
    if (stop != StopReason::none) segment->stop(stop);
    const auto relative = position ? std::optional(*position - origin_) : std::nullopt;
    const bool is_over = segment->sent(force, relative) || stop != StopReason::none;
    segment->show(live);
    if (is_over) finish(segment);
  }
  board_.put(live);
  const std::int64_t end = clock_now();
  body_.add(end - begin);
  if (has_clock_) delay_.add(end - begin + wire_ns_);
  cycles_.store(count + 1, std::memory_order_release);
}

LoopTiming RigLoop::timing() const {
  return {cycles(),           missed_,         unanswered_,      latency_.summary(),
          between_.summary(), body_.summary(), delay_.summary(), delay_.counts()};
}

}  // namespace zwidth::rig
