#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "simulation/loop_schedule.hpp"

namespace zwidth::internal {

// Forces on their way to the device, in the order of their arrival: a ring that never grows.
class ForcesUnderWay {
 public:
  explicit ForcesUnderWay(std::size_t capacity) : ring_(capacity) {}

  struct Force {
    std::size_t tick = 0;  // in which it arrives
    double within = 0.0;   // s from the start of that tick, < its length
    double value = 0.0;
  };

  void clear() noexcept { first_ = count_ = 0; }
  // s from the start of `tick`; never in a later one.
  [[nodiscard]] double next_arrival(std::size_t tick) const noexcept {
    return count_ == 0 || ring_[first_].tick > tick ? std::numeric_limits<double>::infinity() : ring_[first_].within;
  }
  double pop() noexcept {
    const double value = ring_[first_].value;
    first_ = (first_ + 1) % ring_.size();
    --count_;
    return value;
  }
  // Older forces that would arrive later are out of date: they are dropped.
  void push(Force force) noexcept {
    while (count_ > 0 && !arrives_before(at(count_ - 1), force)) --count_;
    if (count_ == ring_.size()) pop();
    at(count_++) = force;
  }

 private:
  static bool arrives_before(const Force& a, const Force& b) noexcept {
    return a.tick < b.tick || (a.tick == b.tick && a.within < b.within);
  }
  [[nodiscard]] Force& at(std::size_t i) noexcept { return ring_[(first_ + i) % ring_.size()]; }

  std::vector<Force> ring_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

// The force of the wall, or of its spring or its damper, from a read to the device.
class RunningPath {
 public:
  // `latest`: s by which a fault may delay a force.
  RunningPath(const LoopSchedule::HeldPath& path, double tick, double latest)
      : line_(path.under_way + 1),
        under_way_(
            static_cast<std::size_t>(std::ceil((path.delay + latest) / (tick * static_cast<double>(path.every)))) + 3),
        delay_(path.delay) {}

  void reset() noexcept {
    std::fill(line_.begin(), line_.end(), 0.0);
    under_way_.clear();
    oldest_ = 0;
    held = asked = 0.0;
  }

  // Undisturbed, by the schedule.
  void send(double force) noexcept {
    line_[oldest_] = force;  // whole samples behind the next one to leave
    oldest_ = oldest_ + 1 == line_.size() ? 0 : oldest_ + 1;
  }
  double arrive() noexcept { return held = line_[oldest_]; }

  // With faults: `within` s of a tick, late by so much.
  void send(double force, std::size_t now, double within, double late, double tick) noexcept {
    const double arrival = within + (delay_ + late);
    const double whole = std::floor(arrival / tick);
    under_way_.push({now + static_cast<std::size_t>(whole), std::max(0.0, std::fma(-whole, tick, arrival)), force});
  }
  [[nodiscard]] double next_arrival(std::size_t tick) const noexcept { return under_way_.next_arrival(tick); }
  double arrive_late() noexcept { return held = under_way_.pop(); }

  double asked = 0.0;  // at the last read
  double held = 0.0;   // that has arrived

 private:
  std::vector<double> line_;
  std::size_t oldest_ = 0;
  ForcesUnderWay under_way_;
  double delay_;
};

}  // namespace zwidth::internal
