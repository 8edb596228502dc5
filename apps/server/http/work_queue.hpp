#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace zwidth::server {

/// Lanes of work, each with threads of its own that take it in turn. The first lane has the processor before the second, and so on:
/// what takes long keeps nothing waiting that a person looks at.
class WorkQueue {
 public:
  /// Of a lane what is more than `most_waiting`, beside as many at work as it has `threads`, is refused.
  WorkQueue(std::size_t lanes, std::size_t threads, std::size_t most_waiting);
  /// Does what still waits.
  ~WorkQueue();
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  /// False where too much waits already. `work` must not throw.
  [[nodiscard]] bool add(std::size_t lane, std::function<void()> work);

 private:
  struct Lane {
    std::condition_variable changed;
    std::deque<std::function<void()>> waiting;
    std::size_t idle = 0;  ///< threads
  };

  void run(std::size_t lane);

  std::size_t most_waiting_;
  bool ends_ = false;
  std::mutex mutex_;
  std::vector<Lane> lanes_;
  std::vector<std::thread> threads_;
};

}  // namespace zwidth::server
