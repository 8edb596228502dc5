#pragma once

#include <chrono>
#include <string>

#include "rig/live_state.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::cli {

/// What a rig does now, on standard error: on a terminal one line, written over ten times a second and wiped at the end;
/// else a line every five seconds of a rig that keeps a clock, and none of one that does not. Colours mark a swing that
/// grows, unless NO_COLOR is set.
class LiveLine {
 public:
  LiveLine(Units units, bool has_clock);
  ~LiveLine();
  LiveLine(const LiveLine&) = delete;
  LiveLine& operator=(const LiveLine&) = delete;

  void show(const rig::LiveState& state);

 private:
  void wipe();

  Units units_;
  bool has_clock_;
  bool terminal_;
  bool coloured_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace zwidth::cli
