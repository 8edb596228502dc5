#pragma once

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <utility>

#include "zwidth/progress.hpp"

namespace zwidth::internal {

/// Where nobody listens it does nothing. Loops whose length is not known tell the same fraction again and again: whoever
/// listens may end the work.
inline void tell(const Progress& progress, double fraction) {
  if (progress) progress(fraction);
}

/// The progress of work in stages, each of which tells its own from 0 to 1. Never falls, whatever a stage tells.
class StagedProgress {  // NOLINT(cppcoreguidelines-special-member-functions): nothing to destroy
 public:
  /// `whole` must outlive this.
  explicit StagedProgress(const Progress& whole) : whole_(whole) {
    if (whole_) stage_ = [this](double fraction) { told(begin_ + fraction * (end_ - begin_)); };
  }
  StagedProgress(const StagedProgress&) = delete;
  StagedProgress& operator=(const StagedProgress&) = delete;

  /// The stage before is done; the next one is until `end` of the whole.
  void next(double end) {
    begin_ = std::exchange(end_, end);
    if (whole_) told(begin_);
  }
  /// All is.
  void done() { next(1.0), next(1.0); }

  /// What the stage that runs tells to, empty where nobody listens; one thread at a time. Must not outlive this.
  [[nodiscard]] const Progress& stage() const { return stage_; }

 private:
  void told(double fraction) {
    reported_ = std::clamp(fraction, reported_, 1.0);
    whole_(reported_);
  }

  const Progress& whole_;
  Progress stage_;
  double begin_ = 0.0;
  double end_ = 0.0;
  double reported_ = 0.0;
};

/// The progress of equal steps that several threads do: told one at a time, and never falling.
class SharedProgress {
 public:
  /// `whole` must outlive this.
  SharedProgress(const Progress& whole, std::size_t steps) : whole_(whole), steps_(static_cast<double>(steps)) {}

  void add(std::size_t steps = 1) {
    if (!whole_) return;
    const std::lock_guard lock(mutex_);
    done_ += steps;
    whole_(static_cast<double>(done_) / steps_);
  }
  /// Within a step.
  void go_on() { add(0); }

 private:
  const Progress& whole_;
  double steps_;
  std::mutex mutex_;
  std::size_t done_ = 0;
};

}  // namespace zwidth::internal
