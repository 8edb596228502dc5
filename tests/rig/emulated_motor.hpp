#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>

#include "rig/damped_device.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"

namespace zwidth::test {

using Clock = std::chrono::steady_clock;

/// The motor behind an emulated drive: a simulated device whose time moves one sampling period with each torque.
class EmulatedMotor {
 public:
  explicit EmulatedMotor(const Device& device)
      : device_(has_damper_loop(device.loop()) ? with_one_rate(device) : device),
        timing_(device.loop().damper),
        loop_(device_, {}),
        drive_(device.parameters().driver.value()) {}

  /// Turns of its shaft.
  [[nodiscard]] double turns() {
    measured_at_ = Clock::now();
    if (is_not_a_number) return std::numeric_limits<double>::quiet_NaN();
    return (damped_ ? damped_->measure() : loop_.measure()) / drive_.position_per_turn();
  }
  /// N m at its shaft, from now on.
  void set_torque(double torque) {
    const double force = (has_wrong_sign ? -1.0 : 1.0) * torque / drive_.torque_per_force();
    force_ = force;
    if (measured_at_ != Clock::time_point{}) {
      delay_ += std::chrono::nanoseconds(Clock::now() - measured_at_).count();
      ++delays_;
    }
    if (damped_) {
      damped_->move(force);
    } else {
      loop_.move(force);
    }
    ++forces_;
    if (force != 0.0) ++nonzero_forces_;
    largest_force_ = std::max(largest_force_.load(), std::abs(force));
  }
  /// The drive closes a damper of its own from now on, N m s/rad at its shaft, in the loop of the device's file: begun at
  /// rest where it is another than before.
  void set_damping(double damping, double filter_hz = 0.0) {
    if (damping == damping_) return;
    damping_ = damping;
    DeviceParameters parameters = device_.parameters();
    parameters.loop.damper = timing_;
    parameters.wall.damping = damping / (drive_.torque_per_force() * drive_.torque_per_force());
    parameters.wall.velocity_filter_hz = filter_hz;
    damped_.emplace(Device(parameters), 0.0);
  }
  [[nodiscard]] double damping() const { return damping_; }
  void let_go() {
    force_ = 0.0;
    ++times_let_go_;
  }
  /// Without counting as a force of the host's.
  void idle() { force_ = 0.0; }
  [[nodiscard]] const MotorDrive& drive() const { return drive_; }

  [[nodiscard]] double force() const { return force_; }
  [[nodiscard]] int forces() const { return forces_; }
  [[nodiscard]] int nonzero_forces() const { return nonzero_forces_; }
  [[nodiscard]] double largest_force() const { return largest_force_; }
  [[nodiscard]] int times_let_go() const { return times_let_go_; }

  /// s, in the mean, from when its position was asked for on the drive to when the force was there; and forget it.
  [[nodiscard]] double mean_delay() {
    return 1e-9 * static_cast<double>(delay_.exchange(0)) / std::max(1, delays_.exchange(0));
  }

  std::atomic<bool> is_not_a_number = false;
  std::atomic<bool> has_wrong_sign = false;  ///< its torque turns it against the way that it counts

 private:
  Device device_;
  std::optional<LoopDamper> timing_;
  HybridLoop loop_;
  std::optional<rig::DampedDevice> damped_;
  std::atomic<double> damping_ = 0.0;
  MotorDrive drive_;
  Clock::time_point measured_at_;
  std::atomic<std::int64_t> delay_ = 0;  // ns, sum
  std::atomic<int> delays_ = 0;
  std::atomic<double> force_ = 0.0;
  std::atomic<int> forces_ = 0;
  std::atomic<int> nonzero_forces_ = 0;
  std::atomic<double> largest_force_ = 0.0;
  std::atomic<int> times_let_go_ = 0;
};

}  // namespace zwidth::test
