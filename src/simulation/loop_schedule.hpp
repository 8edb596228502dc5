#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "zwidth/control/sampled_controller.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// Whether a damper acts that runs at another time than the spring or the relay beside it.
[[nodiscard]] bool damper_runs_apart(const Device& device, const ControllerOptions& controller);
// The same of the device's own wall, whatever its stiffness.
[[nodiscard]] bool damper_runs_apart(const Device& device);

// The loop's period, and where the damper runs apart and faster the damper's, s.
[[nodiscard]] double shortest_period(const Device& device, const ControllerOptions& controller);

// The instants at which a loop reads and its forces arrive, over one tick: the shorter of spring's and damper's period.
struct LoopSchedule {
  enum Path : unsigned char { spring, damper };
  // Something at an instant, or the motion up to the next one.
  struct Event {
    enum class Kind : unsigned char { reads, arrives, moves };
    Kind kind = Kind::moves;
    Path path = spring;
    std::uint32_t length = 0;  // of the motion: which of `lengths`
  };
  // A path's force, held from one sample to the next.
  struct HeldPath {
    std::size_t every = 1;      // ticks between two reads
    std::size_t under_way = 0;  // reads of the path between a read and the arrival of its force
    double delay = 0.0;         // s
  };

  double tick = 0.0;                      // s
  std::size_t ticks_per_step = 1;         // in a period of the spring
  std::vector<HeldPath> paths;            // by Path; without damper only the spring's, which then stands for the wall's
  std::vector<double> lengths;            // s, of every motion; the first is the tick
  std::vector<std::vector<Event>> ticks;  // in the order of time, over the longer of the two periods
};

// Where the damper runs apart, it and the spring read together at the start of every longer period.
[[nodiscard]] LoopSchedule loop_schedule(const Loop& loop, bool damper_runs_apart);

}  // namespace zwidth::internal
