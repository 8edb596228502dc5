#include "rig/rig_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <utility>

#include "rig/real_time.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth::rig {
namespace {

constexpr std::int64_t shortest_look = 1'000'000;  // ns, between looks of the watchdog
constexpr auto wait_for_loop = std::chrono::milliseconds(2);
constexpr unsigned cycles_between_looks = 64;  // at signals and at what the watcher waits for, in lock step
constexpr auto between_tellings = std::chrono::milliseconds(100);

std::atomic<bool> is_interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

/// As many as may be missed on this drive: it must not let go before the rig does.
SafetyLimits with_missed_cycles(SafetyLimits limits, const Driver& driver, double sampling_period) {
  const auto watchdog = driver.facts().watchdog;
  if (watchdog && !driver.facts().lock_step) require_valid(find_problem(limits, sampling_period, *watchdog));
  if (limits.missed_cycles) return limits;
  limits.missed_cycles = allowed_missed_cycles(sampling_period);
  while (watchdog && find_problem(limits, sampling_period, *watchdog)) --*limits.missed_cycles;
  return limits;
}

void on_interrupt(int /*signal*/) { is_interrupted.store(true); }

}  // namespace

InterruptsStopRigs::InterruptsStopRigs() {
  is_interrupted = false;
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  std::signal(SIGHUP, on_interrupt);  // the terminal is gone, the device is not
  std::signal(SIGQUIT, on_interrupt);
  std::signal(SIGTSTP, on_interrupt);  // a program that sleeps holds no force: a drive without a watchdog would
}

InterruptsStopRigs::~InterruptsStopRigs() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGHUP, SIG_DFL);
  std::signal(SIGQUIT, SIG_DFL);
  std::signal(SIGTSTP, SIG_DFL);
}

RigRun::RigRun(Driver& driver, const SafetyLimits& limits, double sampling_period, Watcher watcher)
    : driver_(driver),
      limits_(with_missed_cycles(limits, driver, sampling_period)),
      period_(sampling_period),
      loop_(driver, limits_, sampling_period),
      watcher_(std::move(watcher)),
      told_(std::chrono::steady_clock::now()) {
  if (loop_.has_clock()) remarks_ = lock_memory();
  driver_.allow_missed(*limits_.missed_cycles);
  driver_.arm();
  if (!loop_.has_clock()) return;
  try {
    watchdog_ = std::thread([this] { watch(); });
    clock_ = std::thread([this] { run_on_clock(); });
  } catch (...) {
    halt();
    throw;
  }
}

RigRun::~RigRun() { halt(); }

void RigRun::halt() noexcept {
  is_ending_ = true;
  driver_.disarm();
  if (clock_.joinable()) clock_.join();
  if (watchdog_.joinable()) watchdog_.join();
  interrupts_.reset();
}

void RigRun::run_on_clock() noexcept {
  thread_remarks_ = prepare_real_time_thread();
  const std::int64_t period = std::llround(1e9 * period_);
  std::int64_t due = clock_now() + period;
  has_prepared_.store(true, std::memory_order_release);
  while (!is_ending_.load(std::memory_order_acquire)) {
    sleep_until(due);
    if (is_interrupted.load(std::memory_order_relaxed)) loop_.request_stop(StopReason::interrupted);
    if (has_barked_.load(std::memory_order_acquire)) loop_.request_stop(StopReason::watchdog);
    const std::int64_t now = clock_now();
    loop_.cycle(now, due);
    due += period * std::max<std::int64_t>(1, 1 + (now - due) / period);  // what was missed is not caught up
  }
  driver_.disarm();
}

void RigRun::watch() noexcept {
  const std::int64_t period = std::llround(1e9 * period_);
  const std::int64_t look = std::max(shortest_look, period);
  const std::int64_t patience = (*limits_.missed_cycles + 1) * period + look;
  std::uint64_t seen = 0;
  std::int64_t since = clock_now();
  while (!is_ending_.load(std::memory_order_acquire)) {
    const std::int64_t now = clock_now();
    sleep_until(now + look);
    const std::int64_t woken = clock_now();
    const std::uint64_t cycles = loop_.cycles();
    if (!has_prepared_.load(std::memory_order_acquire) || cycles != seen || woken - now > 2 * look) {
      seen = cycles;
      since = woken;  // the watchdog itself may have been kept from running, and the loop with it
    } else if (woken - since > patience) {
      driver_.disarm();
      has_barked_.store(true, std::memory_order_release);
      loop_.request_stop(StopReason::watchdog);
      return;
    }
  }
}

void RigRun::tell_watcher() noexcept {
  if (!watcher_ || std::chrono::steady_clock::now() - told_ < between_tellings) return;
  told_ = std::chrono::steady_clock::now();
  try {
    watcher_(loop_.look());
  } catch (...) {  // the loop has the segment: whoever watches must not end the wait for it
    watcher_ = {};
  }
}

Played RigRun::play(const Segment& segment) {
  if (segment.cycles == 0 || is_stopped()) return {{}, {}, loop_.stopped()};
  RunningSegment running(segment, period_);
  loop_.play(&running);
  for (unsigned k = 0; !loop_.is_idle(); ++k) {
    if (loop_.has_clock()) {
      std::this_thread::sleep_for(wait_for_loop);
      tell_watcher();
    } else {
      if (k % cycles_between_looks == 0) {
        if (is_interrupted) loop_.request_stop(StopReason::interrupted);
        tell_watcher();
      }
      loop_.cycle(0, 0);
    }
  }
  return running.played();
}

void RigRun::stop(StopReason reason) {
  loop_.request_stop(reason);
  Segment one;
  one.cycles = 1;
  (void)play(one);
}

RigSession RigRun::end() {
  halt();
  RigSession session;
  session.driver = driver_.facts().name;
  session.began = std::chrono::duration<double>(began_.time_since_epoch()).count();
  session.lock_step = driver_.facts().lock_step;
  session.sampling_period = period_;
  session.limits = limits_;
  session.firmware_watchdog = driver_.facts().watchdog;
  session.stop = loop_.stopped();
  session.stopped_at = loop_.stopped_at();
  session.timing = loop_.timing();
  session.drive = driver_.facts().settings;
  session.remarks = remarks_;
  std::ranges::move(thread_remarks_, std::back_inserter(session.remarks));
  if (session.stop == StopReason::lost_link) session.trouble = driver_.trouble();
  return session;
}

}  // namespace zwidth::rig
