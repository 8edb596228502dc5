#pragma once

#include <cstdint>
#include <vector>

#include "zwidth/remark.hpp"

namespace zwidth::rig {

/// The monotonic clock, ns.
[[nodiscard]] std::int64_t clock_now() noexcept;
/// Sleeps until that instant of the clock; at once where it has passed.
void sleep_until(std::int64_t instant) noexcept;

/// Keeps all memory of the process in place, that of stacks and heap to come too. Returns what was not allowed.
[[nodiscard]] std::vector<Remark> lock_memory();

/// Gives the calling thread real-time priority and one processor, and touches its stack. Returns what was not allowed,
/// with the remedy.
[[nodiscard]] std::vector<Remark> prepare_real_time_thread();

}  // namespace zwidth::rig
