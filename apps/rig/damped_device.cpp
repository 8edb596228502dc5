#include "rig/damped_device.hpp"

#include <algorithm>
#include <cmath>

#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth::rig {
namespace {

constexpr double same_instant = 1e-6;  // of a step

/// A device of one rate, that of the grid, whose wall runs elsewhere.
Device device_on_grid(const Device& device, double step, double delay) {
  DeviceParameters parameters = device.parameters();
  parameters.loop.damper.reset();
  parameters.loop.sampling_period = step;
  parameters.loop.delay = delay;
  parameters.wall = {};
  parameters.uncertainty.reset();
  return Device(std::move(parameters));
}

HybridLoopOptions resting_at(const Device& device, double start) {
  HybridLoopOptions options;
  if (start != 0.0) options.initial_position.assign(device.bodies().size(), start);
  return options;
}

ControllerOptions damper_of(const Wall& wall) {
  ControllerOptions options = wall_controller(wall);
  options.stiffness = 0.0;
  options.filters.clear();
  return options;
}

}  // namespace

DampedDevice::Grid DampedDevice::grid_of(const Device& device) {
  const Loop& loop = device.loop();
  const DamperTiming damper = damper_timing(loop);
  if (!(damper.sampling_period < loop.sampling_period)) {
    require_valid(option_problem("loop.damper.sampling_period",
                                 {.code = ProblemCode::damper_not_faster,
                                  .evidence = {{"value", damper.sampling_period}, {"bound", loop.sampling_period}}}));
  }
  const auto ratio = static_cast<std::size_t>(std::llround(loop.sampling_period / damper.sampling_period));
  const double apart = (loop.delay - damper.delay) / damper.sampling_period;
  for (int parts = 1; parts <= finest; ++parts) {
    const double steps = apart * parts;
    if (std::abs(steps - std::round(steps)) > same_instant) continue;
    Grid grid;
    grid.steps_of_damper = static_cast<std::size_t>(parts);
    grid.steps_of_host = ratio * grid.steps_of_damper;
    grid.step = loop.sampling_period / static_cast<double>(grid.steps_of_host);
    const double least = std::min(loop.delay, damper.delay);
    const double whole = std::floor(least / grid.step + same_instant);
    grid.delay = std::max(0.0, least - whole * grid.step);
    const auto later = static_cast<std::size_t>(whole);
    const auto difference = static_cast<std::size_t>(std::abs(std::llround(steps)));
    grid.later_of_host = later + (steps > 0.0 ? difference : 0);
    grid.later_of_damper = later + (steps < 0.0 ? difference : 0);
    return grid;
  }
  require_valid(option_problem("loop.damper.delay", {.code = ProblemCode::delays_apart,
                                                     .evidence = {{"value", std::abs(loop.delay - damper.delay)},
                                                                  {"period", damper.sampling_period},
                                                                  {"most", static_cast<double>(finest)}}}));
  return {};
}

DampedDevice::DampedDevice(const Device& device, double start) : DampedDevice(device, start, grid_of(device)) {}

DampedDevice::DampedDevice(const Device& device, double start, const Grid& grid)
    : grid_(grid),
      loop_(device_on_grid(device, grid.step, grid.delay), resting_at(device, start)),
      damper_(damper_of(device.parameters().wall), damper_timing(device.loop()).sampling_period),
      host_line_(grid.later_of_host),
      damper_line_(grid.later_of_damper) {}

void DampedDevice::move(double force) noexcept {
  for (std::size_t k = 0; k < grid_.steps_of_host; ++k) {
    if (k % grid_.steps_of_damper == 0) damping_force_ = is_damped_ ? damper_.update(loop_.measure()) : 0.0;
    loop_.move(host_line_.pass(force) + damper_line_.pass(damping_force_));
  }
}

}  // namespace zwidth::rig
