#pragma once

#include <cstddef>

#include "rig/rig_run.hpp"

namespace zwidth::test {

/// A wall with all that a wall may have: velocity filter, three notches, two frequencies that are watched.
inline rig::Segment wall_segment(std::size_t cycles) {
  rig::Segment segment;
  segment.controller.kind = ControllerOptions::Kind::wall;
  segment.controller.stiffness = 1000.0;
  segment.controller.damping = 1.0;
  segment.controller.velocity_filter_hz = 100.0;
  segment.controller.filters.assign(3, {.kind = WallFilter::Kind::notch, .frequency_hz = 80.0});
  segment.cycles = cycles;
  segment.watched = {30.0, 200.0};
  return segment;
}

}  // namespace zwidth::test
