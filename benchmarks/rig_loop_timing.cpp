// The rig's loop: percentiles of its body over a million cycles without I/O, what it allocates and which pages it touches;
// then how late its cycles begin on the clock, beside what cyclictest (Debian's rt-tests) sees in the same seconds.
//
//   build/release/benchmarks/rig_loop_timing [CYCLES [SECONDS]]
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "counted_allocations.hpp"
#include "rig/rig_devices.hpp"
#include "rig/rig_run.hpp"
#include "rig/simulated_driver.hpp"
#include "rig/wall_segment.hpp"

namespace zwidth::rig {
namespace {

constexpr double period = 1e-3;
constexpr double most_of_body = 20e-6;  // s, its 99 %

long page_faults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

void print(const char* what, const LatencySummary& summary) {
  fmt::print("{:34} {:>9} {:9.2f} {:9.2f} {:9.2f} {:9.2f} {:9.2f}\n", what, summary.count, 1e6 * summary.p50,
             1e6 * summary.p99, 1e6 * summary.p999, 1e6 * summary.p9999, 1e6 * summary.max);
}

bool time_body(std::size_t cycles) {
  constexpr std::size_t warming = 100;
  SimulatedDriver driver(test::bench_device(2), period, false);
  RigLoop loop(driver, {}, period);
  RunningSegment segment(test::wall_segment(cycles + warming), period);
  loop.play(&segment);
  for (std::size_t k = 0; k < warming; ++k) loop.cycle(0, 0);
  const std::size_t allocations_before = allocations;
  const long faults_before = page_faults();
  for (std::size_t k = 0; k < cycles; ++k) loop.cycle(0, 0);
  const long faults = page_faults() - faults_before;
  const std::size_t allocated = allocations - allocations_before;
  const LatencySummary body = loop.timing().body;
  print("loop body, without I/O", body);
  fmt::print("{:34} {} allocations, {} page faults\n", "", allocated, faults);
  return body.p99 <= most_of_body && allocated == 0 && faults == 0;
}

/// What cyclictest's histogram says, by the microsecond; nothing where there is none.
std::optional<LatencySummary> cyclictest(int seconds, long processor) {
  const std::string command = fmt::format(
      "cyclictest --quiet --mlockall --priority=80 --affinity={} --interval=1000 --loops={} --histogram=100000 "
      "2>/dev/null",
      processor, 1000 * seconds);
  FILE* output = popen(command.c_str(), "r");
  if (output == nullptr) return std::nullopt;
  LatencyHistogram histogram;
  char line[256];
  while (std::fgets(line, sizeof line, output) != nullptr) {
    long microseconds = 0;
    long count = 0;
    if (line[0] == '#' || std::sscanf(line, "%ld %ld", &microseconds, &count) != 2) continue;
    for (long k = 0; k < count; ++k) histogram.add(1000 * microseconds);
  }
  if (pclose(output) != 0 || histogram.summary().count == 0) return std::nullopt;
  return histogram.summary();
}

void time_clock(int seconds) {
  const long processor = sysconf(_SC_NPROCESSORS_ONLN) - 1;  // where the loop runs too
  auto beside = std::async(std::launch::async, [&] { return cyclictest(seconds, processor); });
  SafetyLimits limits;
  limits.missed_cycles = 1000;  // a pause of the machine is what is measured here
  SimulatedDriver driver(test::bench_device(2), 0.0, true);
  RigRun run(driver, limits, period);
  (void)run.play(test::wall_segment(static_cast<std::size_t>(std::lround(seconds / period))));
  const RigSession session = run.end();
  print("loop on the clock: begins late by", session.timing.latency);
  print("loop on the clock: body", session.timing.body);
  if (const auto other = beside.get()) {
    print("cyclictest: wakes late by", *other);
  } else {
    fmt::print("cyclictest: is not there or not allowed: scripts/install-dependencies benchmarks, and as root\n");
  }
  for (const Remark& remark : session.remarks) fmt::print("{}; {}\n", remark.what, remark.remedy);
}

}  // namespace
}  // namespace zwidth::rig

int main(int count, char** arguments) {
  const auto cycles = static_cast<std::size_t>(count > 1 ? std::atol(arguments[1]) : 1'000'000);
  const int seconds = count > 2 ? std::atoi(arguments[2]) : 20;
  fmt::print("{:34} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "us", "count", "p50", "p99", "p99.9", "p99.99", "max");
  const bool is_quick = zwidth::rig::time_body(cycles);
  if (seconds > 0) zwidth::rig::time_clock(seconds);
  fmt::print("{}\n",
             is_quick ? "99 % of the bodies within 20 us, nothing allocated, no page touched" : "NOT within 20 us");
  return is_quick ? 0 : 1;
}
