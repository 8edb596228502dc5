#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include "zwidth/progress.hpp"

namespace zwidth::python {

/// Ends work whose progress it tells, where a signal (Ctrl-C) or the caller's own function raises.
class InterruptibleProgress {
 public:
  /// `told`: None, or called with the fraction done, ten times a second at most.
  explicit InterruptibleProgress(pybind11::object told) : told_(std::move(told)) {}

  struct Interrupted {};  ///< what ends the work

  void operator()(double fraction) {
    const auto now = std::chrono::steady_clock::now();
    {
      const std::lock_guard lock(mutex_);
      if (now < next_ && !raised_) return;
      next_ = now + std::chrono::milliseconds(100);
    }
    const pybind11::gil_scoped_acquire acquired;
    try {
      if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
      if (!told_.is_none()) told_(fraction);
    } catch (pybind11::error_already_set& error) {
      if (!raised_) raised_.emplace(std::move(error));
      throw Interrupted();
    }
  }

  [[nodiscard]] const std::optional<pybind11::error_already_set>& raised() const { return raised_; }

 private:
  pybind11::object told_;
  std::mutex mutex_;
  std::chrono::steady_clock::time_point next_{};
  std::optional<pybind11::error_already_set> raised_;
};

/// work(progress) without the GIL; raises what ended it.
template <typename Work>
auto interruptible(const pybind11::object& told, const Work& work) {
  InterruptibleProgress progress(told);
  try {
    const pybind11::gil_scoped_release released;
    return work(Progress(std::ref(progress)));
  } catch (const InterruptibleProgress::Interrupted&) {
    throw pybind11::error_already_set(*progress.raised());
  }
}

}  // namespace zwidth::python
