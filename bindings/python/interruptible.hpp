#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "zwidth/progress.hpp"

namespace zwidth::python {

/// work() without the interpreter's lock.
///
/// Taking the lock back ends a thread that has outlived the interpreter, by unwinding it: so not in a destructor, which
/// may not be left that way, and with no Python object in between.
template <typename Work>
auto without_lock(const Work& work) {
  std::optional<decltype(work())> result;
  std::exception_ptr failure;
  PyThreadState* thread = PyEval_SaveThread();
  try {
    result.emplace(work());
  } catch (...) {
    failure = std::current_exception();
  }
  PyEval_RestoreThread(thread);
  if (failure) std::rethrow_exception(failure);
  return *std::move(result);
}

/// The interpreter's end, told by atexit: from then on no work asks for its lock to tell progress, inside the library,
/// where a thread could not be ended.
class InterpreterEnd {
 public:
  /// With the lock held: waits for those who tell progress now.
  static void begin() {
    begun_ = true;
    without_lock([] {
      constexpr std::chrono::milliseconds step{1};
      for (int i = 0; tellers_ > 0 && i < longest_wait / step; ++i) std::this_thread::sleep_for(step);
      return true;
    });
  }

  /// Who tells progress, for its lifetime.
  struct Teller {
    Teller() { ++tellers_; }
    ~Teller() { --tellers_; }
    Teller(const Teller&) = delete;
    Teller& operator=(const Teller&) = delete;
    [[nodiscard]] static bool may_tell() { return !begun_; }
  };

 private:
  static constexpr std::chrono::seconds longest_wait{5};
  static inline std::atomic<bool> begun_{false};
  static inline std::atomic<int> tellers_{0};
};

/// Ends work whose progress it tells, where a signal (Ctrl-C) or the caller's own function raises.
class InterruptibleProgress {
 public:
  /// `told`: None, or called with the fraction done, ten times a second at most.
  explicit InterruptibleProgress(const pybind11::object& told) : told_(told) {}

  struct Interrupted {};  ///< what ends the work

  void operator()(double fraction) {
    const auto now = std::chrono::steady_clock::now();
    {
      const std::lock_guard lock(mutex_);
      if (now < next_ && !raised_) return;
      next_ = now + std::chrono::milliseconds(100);
    }
    if (!told(fraction)) {
      for (;;) std::this_thread::sleep_for(std::chrono::hours(1));  // the process ends
    }
  }

  [[nodiscard]] const std::optional<pybind11::error_already_set>& raised() const { return raised_; }

 private:
  /// Whether there still is an interpreter to tell.
  [[nodiscard]] bool told(double fraction) {
    const InterpreterEnd::Teller teller;
    if (!InterpreterEnd::Teller::may_tell()) return false;
    const pybind11::gil_scoped_acquire acquired;
    try {
      if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
      if (!told_.is_none()) told_(fraction);
    } catch (pybind11::error_already_set& error) {
      if (!raised_) raised_.emplace(std::move(error));
      throw Interrupted();
    }
    return true;
  }

  const pybind11::object& told_;
  std::mutex mutex_;
  std::chrono::steady_clock::time_point next_{};
  std::optional<pybind11::error_already_set> raised_;
};

/// work(progress) without the lock; raises what ended it.
template <typename Work>
auto interruptible(const pybind11::object& told, const Work& work) {
  InterruptibleProgress progress(told);
  try {
    return without_lock([&] { return work(Progress(std::ref(progress))); });
  } catch (const InterruptibleProgress::Interrupted&) {
    if (progress.raised()) throw pybind11::error_already_set(*progress.raised());
    throw std::runtime_error("the interpreter ends");
  }
}

}  // namespace zwidth::python
