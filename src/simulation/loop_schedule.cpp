#include "simulation/loop_schedule.hpp"

#include <algorithm>
#include <cmath>

#include "model/rate_ratio.hpp"
#include "sampling/sampling_instants.hpp"
#include "zwidth/model/damper_timing.hpp"

namespace zwidth::internal {
namespace {

using Event = LoopSchedule::Event;

// The force of a path within the tick in which it arrives.
struct Arrival {
  std::size_t tick = 0;  // of the path's period
  double within = 0.0;   // s
  LoopSchedule::Path path = LoopSchedule::spring;
};

std::uint32_t index_of_length(std::vector<double>& lengths, double length) {
  const auto found = std::find(lengths.begin(), lengths.end(), length);
  const auto index = static_cast<std::uint32_t>(found - lengths.begin());
  if (found == lengths.end()) lengths.push_back(length);
  return index;
}

}  // namespace

bool damper_runs_apart(const Device& device, const ControllerOptions& controller) {
  return controller.kind != ControllerOptions::Kind::none && controller.damping > 0.0 && has_damper_loop(device.loop());
}

bool damper_runs_apart(const Device& device) {
  return device.parameters().wall.damping > 0.0 && has_damper_loop(device.loop());
}

double shortest_period(const Device& device, const ControllerOptions& controller) {
  const double period = device.loop().sampling_period;
  return damper_runs_apart(device, controller) ? std::min(period, damper_timing(device.loop()).sampling_period)
                                               : period;
}

LoopSchedule loop_schedule(const Loop& loop, bool damper_runs_apart) {
  LoopSchedule schedule;
  schedule.tick = loop.sampling_period;
  schedule.paths.push_back({1, 0, loop.delay});
  std::size_t ticks = 1;
  if (damper_runs_apart) {
    const DamperTiming damper = damper_timing(loop);
    schedule.paths.push_back({1, 0, damper.delay});
    if (damper.sampling_period <= loop.sampling_period) {
      ticks = periods_within(loop.sampling_period, damper.sampling_period);
      schedule.paths[LoopSchedule::spring].every = schedule.ticks_per_step = ticks;
      schedule.tick = loop.sampling_period / static_cast<double>(ticks);
    } else {
      ticks = periods_within(damper.sampling_period, loop.sampling_period);
      schedule.paths[LoopSchedule::damper].every = ticks;
    }
  }
  std::vector<Arrival> arrivals;
  for (std::size_t i = 0; i < schedule.paths.size(); ++i) {
    LoopSchedule::HeldPath& path = schedule.paths[i];
    const SamplingInstants instants = sampling_instants({schedule.tick, path.delay});
    path.under_way = instants.whole_samples / path.every;
    arrivals.push_back({instants.whole_samples % path.every, instants.with_old, static_cast<LoopSchedule::Path>(i)});
  }
  std::ranges::stable_sort(arrivals, {}, &Arrival::within);

  schedule.lengths = {schedule.tick};
  schedule.ticks.resize(ticks);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    std::vector<Event>& events = schedule.ticks[tick];
    for (std::size_t i = schedule.paths.size(); i-- > 0;) {  // the spring's command is the sum of both
      if (tick % schedule.paths[i].every == 0) {
        events.push_back({Event::Kind::reads, static_cast<LoopSchedule::Path>(i), 0});
      }
    }
    double now = 0.0;
    const auto move_until = [&](double then) {
      if (then > now) events.push_back({Event::Kind::moves, {}, index_of_length(schedule.lengths, then - now)});
      now = then;
    };
    for (const Arrival& arrival : arrivals) {
      if (tick % schedule.paths[arrival.path].every != arrival.tick) continue;
      move_until(arrival.within);
      events.push_back({Event::Kind::arrives, arrival.path, 0});
    }
    move_until(schedule.tick);
  }
  return schedule;
}

}  // namespace zwidth::internal
