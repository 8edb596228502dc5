#include "rig/real_time.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>

namespace zwidth::rig {
namespace {

constexpr std::int64_t second = 1'000'000'000;
constexpr int priority = 80;  // below the kernel's own threads at 99, above its interrupts at 50
constexpr std::size_t stack_in_use = 64 * 1024;

Remark refusal(FindingCode code, int error) {
  return warning({.code = code, .subjects = {{"error", std::strerror(error)}}});
}

}  // namespace

std::int64_t clock_now() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * second + now.tv_nsec;
}

void sleep_until(std::int64_t instant) noexcept {
  const timespec until{instant / second, instant % second};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

std::vector<Remark> lock_memory() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  // Locking what is to come with too low a limit would make later allocations fail.
  const int flags = limit.rlim_cur == RLIM_INFINITY ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT;
  if (mlockall(flags) == 0) return {};
  return {refusal(FindingCode::memory_not_locked, errno)};
}

std::vector<Remark> prepare_real_time_thread() {
  std::vector<Remark> remarks;
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters); error != 0) {
    remarks.push_back(refusal(FindingCode::no_real_time_priority, error));
  }
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof(allowed), &allowed) == 0) {
    std::size_t last = 0;  // the highest: what is isolated from other work usually is
    for (std::size_t cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
      if (CPU_ISSET(cpu, &allowed)) last = cpu;
    }
    CPU_ZERO(&allowed);
    CPU_SET(last, &allowed);
    const int error = pthread_setaffinity_np(pthread_self(), sizeof(allowed), &allowed);
    if (error != 0) remarks.push_back(refusal(FindingCode::no_processor_of_its_own, error));
  }
  std::array<char, stack_in_use> stack{};
  asm volatile("" : : "r"(stack.data()) : "memory");  // so that the pages are touched indeed
  return remarks;
}

}  // namespace zwidth::rig
