#pragma once

#include <array>
#include <atomic>
#include <cstddef>

#include "zwidth/rig/oscillation_watch.hpp"

namespace zwidth::rig {

/// What a loop does now, for people who watch it.
struct LiveState {
  double time = 0.0;       ///< s, from the start
  double position = 0.0;   ///< m or rad, from the start
  double force = 0.0;      ///< sent, N or N m
  double stiffness = 0.0;  ///< K of the wall that runs; 0: none does
  double damping = 0.0;    ///< B of it
  WatchedSwing swing;      ///< at the predicted frequencies, in the last whole window
  double worst = 0.0;      ///< s, the longest cycle so far
};

/// What the loop last put down, for another thread to look at. Nobody waits: each number is that of the last cycle, or
/// of the one that is being put down.
class LiveBoard {
 public:
  void put(const LiveState& state) noexcept {
    const std::array<double, size> values{
        state.time,    state.position,        state.force,           state.stiffness,
        state.damping, state.swing.frequency, state.swing.amplitude, state.swing.growth_rate,
        state.worst};
    for (std::size_t i = 0; i < size; ++i) values_[i].store(values[i], std::memory_order_relaxed);
  }
  [[nodiscard]] LiveState look() const noexcept {
    const auto value = [&](std::size_t i) { return values_[i].load(std::memory_order_relaxed); };
    return {value(0), value(1), value(2), value(3), value(4), {value(5), value(6), value(7)}, value(8)};
  }

 private:
  static constexpr std::size_t size = 9;
  static_assert(std::atomic<double>::is_always_lock_free);
  std::array<std::atomic<double>, size> values_{};
};

}  // namespace zwidth::rig
