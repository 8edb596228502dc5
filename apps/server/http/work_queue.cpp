#include "server/http/work_queue.hpp"

#include <algorithm>
#include <utility>

namespace zwidth::server {

WorkQueue::WorkQueue(std::size_t threads, std::size_t most_waiting) : most_waiting_(most_waiting), idle_(threads) {
  threads_.emplace_back([this] { run(Kind::quick); });
  for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { run(Kind::any); });
}

WorkQueue::~WorkQueue() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  for (std::thread& each : threads_) each.join();
}

bool WorkQueue::add(Kind kind, std::function<void()> work) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= idle_ + most_waiting_) return false;
    waiting_.push_back({kind, std::move(work)});
  }
  changed_.notify_all();
  return true;
}

std::deque<WorkQueue::Waiting>::iterator WorkQueue::next(Kind of_thread) {
  if (of_thread == Kind::any) return waiting_.begin();
  return std::ranges::find(waiting_, Kind::quick, &Waiting::kind);
}

void WorkQueue::run(Kind of_thread) {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return ends_ || next(of_thread) != waiting_.end(); });
    const auto taken = next(of_thread);
    if (taken == waiting_.end()) return;
    std::function<void()> work = std::move(taken->work);
    waiting_.erase(taken);
    if (of_thread == Kind::any) --idle_;
    lock.unlock();
    work();
    work = nullptr;
    lock.lock();
    if (of_thread == Kind::any) ++idle_;
  }
}

}  // namespace zwidth::server
