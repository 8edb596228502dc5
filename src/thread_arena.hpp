#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <optional>

namespace zwidth::internal {

/// As many threads as are asked for, 0: all cores. More than there are cores too: TBB would refuse those with a warning.
class ThreadArena {
 public:
  explicit ThreadArena(std::size_t threads)
      : arena_(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads)) {
    const std::size_t allowed = Control::active_value(Control::max_allowed_parallelism);
    if (threads > allowed) more_.emplace(Control::max_allowed_parallelism, threads);
  }

  template <typename Work>
  void execute(const Work& work) {
    arena_.execute(work);
  }

 private:
  using Control = tbb::global_control;

  std::optional<Control> more_;
  tbb::task_arena arena_;
};

}  // namespace zwidth::internal
