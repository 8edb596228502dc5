#include "server/http/work_queue.hpp"

#include <sys/resource.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace zwidth::server {
namespace {

constexpr int nicer_per_lane = 2;

/// Of this thread, and of those that it starts.
void lower_priority(int by) {
  const auto thread = static_cast<id_t>(::gettid());
  (void)::setpriority(PRIO_PROCESS, thread, ::getpriority(PRIO_PROCESS, thread) + by);
}

}  // namespace

WorkQueue::WorkQueue(std::size_t lanes, std::size_t threads, std::size_t most_waiting)
    : most_waiting_(most_waiting), lanes_(lanes) {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    lanes_[lane].idle = threads;
    for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this, lane] { run(lane); });
  }
}

WorkQueue::~WorkQueue() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  for (Lane& each : lanes_) each.changed.notify_all();
  for (std::thread& each : threads_) each.join();
}

bool WorkQueue::add(std::size_t lane, std::function<void()> work) {
  Lane& to = lanes_.at(lane);
  {
    const std::lock_guard lock(mutex_);
    if (to.waiting.size() >= to.idle + most_waiting_) return false;
    to.waiting.push_back(std::move(work));
  }
  to.changed.notify_one();
  return true;
}

void WorkQueue::run(std::size_t lane) {
  lower_priority(nicer_per_lane * static_cast<int>(lane));
  Lane& own = lanes_[lane];
  // Threads of TBB keep the priority that they began with, whoever they work for: one core is kept from what takes long.
  tbb::task_arena arena(lane == 0 ? tbb::task_arena::automatic : std::max(1, tbb::info::default_concurrency() - 1));
  std::unique_lock lock(mutex_);
  for (;;) {
    own.changed.wait(lock, [&] { return ends_ || !own.waiting.empty(); });
    if (own.waiting.empty()) return;
    const std::function<void()> work = std::move(own.waiting.front());
    own.waiting.pop_front();
    --own.idle;
    lock.unlock();
    arena.execute(work);
    lock.lock();
    ++own.idle;
  }
}

}  // namespace zwidth::server
