#include "rig/simulated_driver.hpp"

namespace zwidth::rig {
namespace {

HybridLoopOptions starting_at(const Device& device, double start) {
  HybridLoopOptions options;
  if (start != 0.0) options.initial_position.assign(device.bodies().size(), start);
  return options;
}

}  // namespace

SimulatedDriver::SimulatedDriver(const Device& device, double start, bool real_time)
    : facts_{.name = "simulated", .is_simulated = true, .lock_step = !real_time, .is_zeroed = true},
      loop_(device, starting_at(device, start)) {}

}  // namespace zwidth::rig
