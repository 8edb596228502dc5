#include "rig/simulated_driver.hpp"

#include "zwidth/model/damper_timing.hpp"

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
      start_(start),
      loop_(has_damper_loop(device.loop()) ? with_one_rate(device) : device, starting_at(device, start)) {}

void SimulatedDriver::close_damper(const Device& device, std::optional<double> /*force_limit*/) {
  damped_.emplace(device, start_);
}

void SimulatedDriver::send(double force) noexcept {
  if (!damped_) return loop_.move(force);
  if (is_disarmed()) damped_->let_go();
  damped_->move(force);
}

}  // namespace zwidth::rig
