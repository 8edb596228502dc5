#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "zwidth/control/running_filter.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth {

/// Force from position, once per sampling period: none, a virtual wall, or a relay.
struct ControllerOptions {
  enum class Kind { none, wall, relay };
  Kind kind = Kind::none;

  // Wall: C(z) = F(z) (K + B v(z)) on the penetration of the measured position into `position`.
  double stiffness = 0.0;                ///< K, N/m or N m/rad; >= 0
  double damping = 0.0;                  ///< B, N s/m or N m s/rad; >= 0
  double velocity_filter_hz = 0.0;       ///< f_c; 0: none
  std::vector<WallFilter> filters = {};  ///< F: on the whole force, in the order in which they run; at most 20
  double position = 0.0;                 ///< where the wall begins, m or rad; it fills all beyond
  enum class Contact {
    bilateral,   ///< a spring on both sides: the linear loop
    unilateral,  ///< what enters the filters is 0 outside the wall and never pulls; what leaves them never pulls
  };
  Contact contact = Contact::bilateral;

  // Relay: -amplitude where the measured position lies above `position` + hysteresis, +amplitude below
  // `position` - hysteresis, unchanged in between (and exactly at `position`).
  double amplitude = 0.0;   ///< N or N m; > 0
  double hysteresis = 0.0;  ///< m or rad; >= 0
};

/// The wall of a device file as a bilateral spring at 0; without wall.stiffness, K = 0.
[[nodiscard]] ControllerOptions wall_controller(const Wall& wall);

/// The controller as it runs on the device: one call per sample, no allocation, no exception. The same object serves
/// the simulation and a real loop.
class SampledController {
 public:
  /// Throws Error (invalid_argument) for a value outside its domain or a period that is not > 0.
  SampledController(const ControllerOptions& options, double sampling_period);

  /// Force to command for this sample's measured position. The first call takes the device to be at rest.
  [[nodiscard]] double update(double measured) noexcept;

  /// Forgets the past: the next call is the first.
  void reset() noexcept;

 private:
  [[nodiscard]] double wall_force(double measured) noexcept;

  ControllerOptions options_;
  double rate_ = 0.0;    // 1/T
  double filter_ = 0.0;  // a of (1 - a)/(1 - a z^-1)
  std::array<RunningFilter, max_wall_filters> filters_{};
  std::size_t filter_count_ = 0;
  bool started_ = false;
  double previous_ = 0.0;
  double velocity_ = 0.0;
  double relay_force_ = 0.0;
};

}  // namespace zwidth
