#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace zwidth::server {

/// Threads that take work in turn, and one more that takes quick work alone: what takes long does not keep it waiting.
class WorkQueue {
 public:
  enum class Kind : std::uint8_t { any, quick };

  /// What is more than `most_waiting`, beside as many at work as there are `threads`, is refused.
  WorkQueue(std::size_t threads, std::size_t most_waiting);
  /// Does what still waits.
  ~WorkQueue();
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  /// False where too much waits already. `work` must not throw.
  [[nodiscard]] bool add(Kind kind, std::function<void()> work);

 private:
  struct Waiting {
    Kind kind = Kind::any;
    std::function<void()> work;
  };

  /// Of the thread for quick work; else the first of all.
  [[nodiscard]] std::deque<Waiting>::iterator next(Kind of_thread);
  void run(Kind of_thread);

  std::size_t most_waiting_;
  std::size_t idle_ = 0;  ///< threads that take any
  bool ends_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  std::vector<std::thread> threads_;
};

}  // namespace zwidth::server
