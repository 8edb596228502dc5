#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace zwidth::server {

/// Threads that take work in turn; what is more than may wait is refused.
class WorkQueue {
 public:
  WorkQueue(std::size_t threads, std::size_t most_waiting);
  /// Does what still waits.
  ~WorkQueue();
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  /// False where too much waits already. `work` must not throw.
  [[nodiscard]] bool add(std::function<void()> work);

 private:
  void run();

  std::size_t most_waiting_;
  std::size_t idle_ = 0;
  bool ends_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  std::vector<std::thread> threads_;
};

}  // namespace zwidth::server
