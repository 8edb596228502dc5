#pragma once

#include <cstddef>
#include <vector>

#include "zwidth/control/sampled_controller.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"

namespace zwidth::rig {

/// A device whose drive closes the wall's damper at its own rate, beside a force from a host: its exact motion.
///
/// Its time moves in steps of the damper's period, or of parts of it where the two delays differ by such: both forces
/// arrive at the instants of that grid, each by its own delay.
class DampedDevice {
 public:
  /// `start`: where all bodies are at rest, m or rad. Throws Error (invalid_argument) for a damper that is not faster than
  /// the spring, delays with no common grid of `finest` parts of the damper's period, and as HybridLoop does.
  DampedDevice(const Device& device, double start);

  static constexpr int finest = 1000;

  /// What the encoder gives at the host's instant.
  [[nodiscard]] double measure() noexcept { return loop_.measure(); }
  /// Moves the device by one period of the host, with this force of the host's commanded now, N or N m.
  void move(double force) noexcept;
  /// The drive lets go: no damper from now on.
  void let_go() noexcept { is_damped_ = false; }

 private:
  /// A force that arrives whole steps later.
  class Line {
   public:
    explicit Line(std::size_t steps) : forces_(steps + 1) {}
    [[nodiscard]] double pass(double force) noexcept {
      forces_[next_] = force;
      next_ = next_ + 1 == forces_.size() ? 0 : next_ + 1;
      return forces_[next_];
    }

   private:
    std::vector<double> forces_;
    std::size_t next_ = 0;
  };
  struct Grid {
    double step = 0.0;              // s
    double delay = 0.0;             // s, of both forces, below a step
    std::size_t steps_of_host = 1;  // in its period
    std::size_t steps_of_damper = 1;
    std::size_t later_of_host = 0;  // steps beside that delay
    std::size_t later_of_damper = 0;
  };
  [[nodiscard]] static Grid grid_of(const Device& device);
  DampedDevice(const Device& device, double start, const Grid& grid);

  Grid grid_;
  HybridLoop loop_;
  SampledController damper_;
  Line host_line_;
  Line damper_line_;
  double damping_force_ = 0.0;
  bool is_damped_ = true;
};

}  // namespace zwidth::rig
