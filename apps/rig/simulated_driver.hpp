#pragma once

#include "rig/driver.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"

namespace zwidth::rig {

/// The device of a file, simulated: its exact motion, one sampling period per command.
class SimulatedDriver : public Driver {
 public:
  /// `start`: where all bodies are at rest, m or rad. `real_time`: the loop keeps its clock although nothing needs it.
  /// Throws Error as HybridLoop does.
  SimulatedDriver(const Device& device, double start, bool real_time);

  [[nodiscard]] const DriverFacts& facts() const noexcept override { return facts_; }
  void arm() override {}
  [[nodiscard]] std::optional<double> measure() noexcept override { return loop_.measure(); }
  [[nodiscard]] std::optional<bool> proves_watchdog() override { return std::nullopt; }

 protected:
  void send(double force) noexcept override { loop_.move(force); }
  void send_idle() noexcept override {}

 private:
  DriverFacts facts_;
  HybridLoop loop_;
};

}  // namespace zwidth::rig
