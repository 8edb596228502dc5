#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "property/random_devices.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::test {

// Devices with a damper 2 to 20 times as fast as the spring, or as slow, with delays of either beyond a period.
class RandomTwoRates {
 public:
  explicit RandomTwoRates(std::uint64_t seed) : random_(seed) {}

  Device next() {
    static constexpr std::array kinds{"rigid",    "two_mass", "user_side", "three_mass",
                                      "operator", "grounded", "rotary",    "actuator_lag"};
    const std::string_view kind = kinds[random_.index(kinds.size())];
    DeviceParameters device = random_.device(kind);
    device.wall = {};
    const double ratio = static_cast<double>(2 + random_.index(19));
    const bool is_fast = random_.chance(0.5);
    double& period = device.loop.sampling_period;
    const double damper_period = is_fast ? period / ratio : period * ratio;
    const double longer = std::max(period, damper_period);
    device.loop.delay = random_.chance(0.3) ? 0.0 : random_.uniform(0.0, 1.3) * period;
    const double damper_delay = random_.chance(0.3) ? 0.0 : random_.uniform(0.0, 1.3) * damper_period;
    const CriticalStiffness undamped = critical_stiffness(Device(device));
    device.loop.damper = LoopDamper{damper_period, damper_delay};
    if (undamped.status == StiffnessStatus::finite) {
      device.wall.damping = random_.log_uniform(0.03, 0.5) * undamped.stiffness * longer;
    }
    if (random_.chance(0.3)) device.wall.velocity_filter_hz = random_.uniform(0.05, 0.4) / damper_period;
    device.name = std::string(kind) + (is_fast ? ", fast damper, " : ", slow damper, ") + std::to_string(count_++);
    return Device(device);
  }

 private:
  RandomDevices random_;
  int count_ = 0;
};

// The largest positions of the third and of the last quarter of so many longer periods of the wall, as a ratio.
inline double growth_in_time(const Device& device, double stiffness, std::size_t samples) {
  HybridLoopOptions options;
  options.controller = wall_controller(device.parameters().wall);
  options.controller.stiffness = stiffness;
  for (std::size_t i = 0; i < device.bodies().size(); ++i) {
    options.initial_position.push_back(1e-3 * (1.0 + 0.3 * static_cast<double>(i)));
  }
  HybridLoop loop(device, options);
  double third = 0.0;
  double last = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    loop.step();
    double& largest = 4 * k < 3 * samples ? third : last;
    if (2 * k >= samples) largest = std::max(largest, std::abs(loop.sensed_position()));
  }
  return last / third;
}

// Whether growth at 1.01 and decay at 0.99 of the critical stiffness could be seen: a finite limit of a wall that is stable
// from K = 0 on, whose poles there move fast enough. Expects both.
inline bool compare_in_time(const Device& device) {
  constexpr double most_ticks = 1e6;
  const CriticalStiffness critical = critical_stiffness(device);
  if (critical.status != StiffnessStatus::finite || !critical.trust.sound() ||
      device.parameters().wall.damping == 0.0) {
    return false;
  }
  const internal::ScheduledLoop as_it_runs =
      internal::TwoRateDevice(device, device.parameters().wall.damping).as_it_runs(device);
  const double period = device.loop().sampling_period;
  const double shorter = std::min(period, damper_timing(device.loop()).sampling_period);
  std::vector<std::pair<double, std::size_t>> runs;
  for (const double share : {0.99, 1.01}) {
    double largest = 0.0;
    for (const std::complex<double>& each : as_it_runs.poles_minus_one(share * critical.stiffness)) {
      largest = std::max(largest, std::abs(1.0 + each));
    }
    // A quarter of the run changes the motion by e^2 and holds many periods.
    const double duration = std::max(8.0 / std::abs(std::log(largest)), 400.0) * as_it_runs.period();
    if (!(duration / shorter < most_ticks) || duration / as_it_runs.period() * std::abs(std::log(largest)) > 600.0) {
      return false;
    }
    runs.emplace_back(share, static_cast<std::size_t>(duration / period));
  }
  for (const auto& [share, samples] : runs) {
    const double growth = growth_in_time(device, share * critical.stiffness, samples);
    EXPECT_EQ(growth > 1.0, share > 1.0) << share << " of the critical stiffness: " << growth;
    EXPECT_GT(std::abs(std::log(growth)), 0.5);
  }
  return true;
}

}  // namespace zwidth::test
