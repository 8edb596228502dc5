// The body of the loop allocates nothing. This file replaces the global operators of the whole test program.
#include "rig/rig_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "counted_allocations.hpp"
#include "rig/rig_devices.hpp"
#include "rig/rig_run.hpp"
#include "rig/simulated_driver.hpp"
#include "rig/wall_segment.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::rig {
namespace {

long page_faults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

TEST(RigLoop, AMillionCyclesAllocateNothingAndTouchNoNewPage) {
  constexpr std::size_t cycles = 1'000'000;
  SimulatedDriver driver(test::bench_device(2), 1e-3, false);
  RigLoop loop(driver, {}, 1e-3);
  RunningSegment segment(test::wall_segment(cycles + 1000), 1e-3);
  loop.play(&segment);
  for (int k = 0; k < 100; ++k) loop.cycle(0, 0);
  const std::size_t allocations_before = allocations;
  const long faults_before = page_faults();
  for (std::size_t k = 0; k < cycles; ++k) loop.cycle(0, 0);
  const long faults = page_faults() - faults_before;
  EXPECT_EQ(allocations, allocations_before);
  EXPECT_EQ(faults, 0);
  EXPECT_FALSE(loop.is_idle());
  EXPECT_EQ(loop.cycles(), cycles + 100);
  EXPECT_EQ(loop.recorder().size(), 60000U) << "the last minute";
  // Of the body without I/O; a percentile, for these machines pause.
  EXPECT_LT(loop.timing().body.p99, 20e-6);
}

/// A device that does as it is told.
class ToldDriver : public Driver {
 public:
  explicit ToldDriver(bool has_clock) : facts_{.name = "told", .lock_step = !has_clock, .is_zeroed = true} {}
  [[nodiscard]] const DriverFacts& facts() const noexcept override { return facts_; }
  void arm() override { armed = true; }
  [[nodiscard]] std::optional<double> measure() noexcept override {
    for (int k = stall.exchange(0); k > 0; --k) sleep_for_ms();
    return is_linked ? std::optional(position.load()) : std::nullopt;
  }
  [[nodiscard]] std::optional<bool> proves_watchdog() override { return std::nullopt; }

  std::atomic<double> position = 1e-3;
  std::atomic<double> force = 0.0;
  std::atomic<bool> is_linked = true;
  std::atomic<bool> is_idle = false;
  std::atomic<int> stall = 0;  // ms
  bool armed = false;

 protected:
  void send(double value) noexcept override { force = value; }
  void send_idle() noexcept override {
    is_idle = true;
    force = 0.0;
  }

 private:
  static void sleep_for_ms() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }
  DriverFacts facts_;
};

TEST(RigRun, EndsWithZeroForceAndTheDriveIdle) {
  ToldDriver driver(false);
  {
    RigRun run(driver, {}, 1e-3);
    EXPECT_TRUE(driver.armed);
    Segment segment = test::wall_segment(500);
    segment.watched.clear();
    const Played played = run.play(segment);
    EXPECT_EQ(played.force.size(), 500U);
    EXPECT_LT(driver.force, 0.0);
  }
  EXPECT_TRUE(driver.is_idle);
  EXPECT_EQ(driver.force, 0.0);
  driver.command(3.0);
  EXPECT_EQ(driver.force, 0.0) << "for good";
}

TEST(RigRun, EachFaultIsToldAndRecorded) {
  const auto stopped_by = [](const std::function<void(ToldDriver&)>& fault) {
    ToldDriver driver(false);
    SafetyLimits limits;
    limits.position = 0.1;
    limits.missed_cycles = 3;
    RigRun run(driver, limits, 1e-3);
    (void)run.play(test::wall_segment(50));
    fault(driver);
    const Played played = run.play(test::wall_segment(500));
    EXPECT_LE(played.force.size(), 3U);
    EXPECT_EQ(driver.force, 0.0);
    EXPECT_TRUE(run.play(test::wall_segment(500)).force.empty()) << "nothing runs any more";
    const RigSession session = run.end();
    EXPECT_EQ(run.recorder().size(), 50 + played.force.size());
    std::string csv;
    run.recorder().write([&](std::string_view piece) { csv += piece; });
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + std::ptrdiff_t(run.recorder().size()));
    EXPECT_THAT(explanation(session.stop), testing::HasSubstr("force is zero"));
    return session.stop;
  };
  EXPECT_EQ(stopped_by([](ToldDriver& d) { d.is_linked = false; }), StopReason::lost_link);
  EXPECT_EQ(stopped_by([](ToldDriver& d) { d.position = std::numeric_limits<double>::quiet_NaN(); }),
            StopReason::not_a_number);
  EXPECT_EQ(stopped_by([](ToldDriver& d) { d.position = 0.2; }), StopReason::position_limit);
}

TEST(RigRun, AnOscillationEndsTheSegmentNotTheSession) {
  const Device device = test::bench_device(1);
  SimulatedDriver driver(device, 1e-3, false);
  RigRun run(driver, {}, 1e-3);
  const CriticalStiffness limit = critical_stiffness(device);
  Segment segment;
  segment.controller.kind = ControllerOptions::Kind::wall;
  segment.controller.stiffness = 3.0 * limit.stiffness;
  segment.cycles = 1'000'000;
  segment.watched = {limit.limit->frequency};
  const Played played = run.play(segment);
  EXPECT_EQ(played.stop, StopReason::oscillation);
  EXPECT_LT(played.force.size(), 100'000U);
  EXPECT_FALSE(run.is_stopped());
  segment.controller.stiffness = 0.5 * limit.stiffness;
  segment.cycles = 1000;
  EXPECT_EQ(run.play(segment).stop, StopReason::none);
}

TEST(RigRun, OnTheClockALoopThatStandsStillIsDisarmedByTheWatchdog) {
  ToldDriver driver(true);
  RigRun run(driver, {}, 2e-3);
  driver.stall = 200;
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!driver.is_idle && std::chrono::steady_clock::now() < patience) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(driver.is_idle);
  (void)run.play(test::wall_segment(100000));
  const RigSession session = run.end();
  EXPECT_TRUE(session.stop == StopReason::watchdog || session.stop == StopReason::missed_cycles);
  EXPECT_EQ(driver.force, 0.0);
}

// What people see is told by the thread that waits, whatever becomes of it; the loop's own never does.
TEST(RigRun, TellsAWatcherFromTheWaitingThread) {
  ToldDriver driver(true);
  SafetyLimits limits;
  limits.missed_cycles = 1000;
  limits.ramp = 0.0;
  std::vector<LiveState> seen;
  RigRun run(driver, limits, 2e-3, [&, own = std::this_thread::get_id()](const LiveState& state) {
    EXPECT_EQ(std::this_thread::get_id(), own);
    if (state.stiffness == 0.0) return;  // before the first cycle of the segment
    seen.push_back(state);
    if (seen.size() == 2) throw std::runtime_error("a watcher that fails is not asked again");
  });
  driver.position = 2e-3;
  Segment segment = test::wall_segment(500);
  EXPECT_EQ(run.play(segment).force.size(), 500U);
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(seen[0].stiffness, 1000.0);
  EXPECT_EQ(seen[0].damping, 1.0);
  EXPECT_GT(seen[1].time, seen[0].time);
  EXPECT_GT(seen[1].worst, 0.0);
}

TEST(RigRun, OnTheClockItKeepsItsRateInTheMiddle) {
  ToldDriver driver(true);
  SafetyLimits limits;
  limits.missed_cycles = 1000;
  RigRun run(driver, limits, 2e-3);
  Segment segment = test::wall_segment(500);
  segment.watched.clear();
  (void)run.play(segment);
  const RigSession session = run.end();
  EXPECT_NEAR(session.timing.period.p50, 2e-3, 1e-3);
  EXPECT_GE(session.timing.cycles, 500U);
  EXPECT_GT(session.timing.latency.count, 400U);
}

TEST(LatencyHistogram, PercentilesAreWithinTwoThousandths) {
  LatencyHistogram histogram;
  for (int k = 1; k <= 100000; ++k) histogram.add(k * 100);
  const LatencySummary summary = histogram.summary();
  EXPECT_EQ(summary.count, 100000U);
  EXPECT_NEAR(summary.p50, 5e-3, 1e-5);
  EXPECT_NEAR(summary.p99, 9.9e-3, 2e-5);
  EXPECT_NEAR(summary.p999, 9.99e-3, 2e-5);
  EXPECT_NEAR(summary.p9999, 9.999e-3, 2e-5);
  EXPECT_DOUBLE_EQ(summary.max, 1e-2);
  std::uint64_t all = 0;
  double sum = 0.0;
  for (const DurationCount& each : histogram.counts()) {
    all += each.count;
    sum += static_cast<double>(each.count) * each.duration;
  }
  EXPECT_EQ(all, 100000U);
  EXPECT_NEAR(sum / 1e5, 5e-3, 1e-5);
  histogram.add(std::numeric_limits<std::int64_t>::max());
  histogram.add(-5);
  EXPECT_GT(histogram.summary().max, 100.0);
  EXPECT_EQ(LatencyHistogram().summary().p50, 0.0);
}

}  // namespace
}  // namespace zwidth::rig
