#pragma once

#include <optional>

#include "rig/damped_device.hpp"
#include "rig/driver.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"

namespace zwidth::rig {

/// The device of a file, simulated: its exact motion, one sampling period per command. Its drive closes the damper where it
/// is told to, at the rate and with the delay of the file.
class SimulatedDriver : public Driver {
 public:
  /// `start`: where all bodies are at rest, m or rad. `real_time`: the loop keeps its clock although nothing needs it.
  /// Throws Error as HybridLoop does.
  SimulatedDriver(const Device& device, double start, bool real_time);

  [[nodiscard]] const DriverFacts& facts() const noexcept override { return facts_; }
  /// The force limit is the device's.
  void close_damper(const Device& device, std::optional<double> force_limit) override;
  void arm() override {}
  [[nodiscard]] std::optional<double> measure() noexcept override {
    return damped_ ? damped_->measure() : loop_.measure();
  }
  [[nodiscard]] std::optional<bool> proves_watchdog() override { return std::nullopt; }

 protected:
  void send(double force) noexcept override;
  void send_idle() noexcept override {}

 private:
  DriverFacts facts_;
  double start_;
  HybridLoop loop_;
  std::optional<DampedDevice> damped_ = {};
};

}  // namespace zwidth::rig
