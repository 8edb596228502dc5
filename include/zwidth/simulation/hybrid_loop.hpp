#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "zwidth/control/sampled_controller.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth {

/// A force of the user on the held body.
struct UserForce {
  /// How the user pushes.
  enum class Kind {
    none,
    step,      ///< `amplitude` from `start` on
    ramp,      ///< amplitude (t - start), from `start` on; amplitude in N/s
    sine,      ///< amplitude sin(frequency (t - start)), from `start` on
    recorded,  ///< `samples` at start + k period, linear in between, 0 before and after
  };
  Kind kind = Kind::none;       ///< of this push
  double amplitude = 0.0;       ///< N or N m (ramp: per s)
  double frequency = 0.0;       ///< rad/s; > 0 for a sine
  double start = 0.0;           ///< s; >= 0
  std::vector<double> samples;  ///< N or N m, of a recorded push
  double period = 0.0;          ///< s; > 0 for a recorded force
};

/// What goes wrong at times in a real controller. A force that would arrive after a newer one is dropped. Where the damper
/// runs apart, each sample of spring and damper has its own fate.
struct Faults {
  double lost_sample_probability = 0.0;  ///< nothing is measured or computed: the last force stays
  double sampling_jitter = 0.0;          ///< s; each sample is late by a uniform part of it; < T, and the damper's
  double overrun_probability = 0.0;      ///< the force is delivered late
  double overrun_delay = 0.0;            ///< s, by which it then is late; at most max_delay_samples periods
  std::uint64_t seed = 1;                ///< of all that is drawn at random
};

/// The loop to run: what commands it, who pushes, what goes wrong.
struct HybridLoopOptions {
  ControllerOptions controller;          ///< of the actuator's force
  UserForce user_force;                  ///< on the held body
  Faults faults;                         ///< none by default
  std::vector<double> initial_position;  ///< of every body, m or rad; empty: 0
  std::vector<double> initial_velocity;  ///< m/s or rad/s; empty: 0
};

/// The first member outside its domain for this device. (That Coulomb friction acts on too many bodies, or the device
/// moves too fast to be followed in time, only the construction of a HybridLoop finds out.)
[[nodiscard]] std::optional<OptionProblem> find_problem(const HybridLoopOptions& options, const Device& device);

/// The sampled loop in time, exactly: the continuous device between samples, the controller at its instants.
///
/// Each step is one sampling period: measure (encoder rounding to the nearest step), update the controller, limit the
/// force, let it arrive t_d later (any real delay), move the device. The motion is the exact solution: matrix
/// exponentials and, at stick-slip instants of Coulomb friction, located events; nothing is integrated step by step.
///
/// Where loop.damper runs the controller's damper apart, a step is still one period of the spring: the damper reads,
/// rounded likewise, at every whole part or multiple of it, its force arrives after its own delay, and the force limit
/// acts on the sum of the two forces that have arrived. A relay, too, then has the controller's damper beside it.
///
/// Uses sampling_period, delay, damper, actuator, sensor.resolution, body.coulomb and the user of the device; the wall is
/// the controller's. Nothing allocates, locks or throws after construction.
class HybridLoop {
 public:
  /// Throws Error (invalid_argument) with member and value where find_problem() finds one, for
  /// Coulomb friction on more than six bodies, or where user force, friction or faults act and the device's fastest
  /// motion has more than some 10 000 rad per sampling period; (needs_bodies) for a user force, motion or friction on a
  /// transfer function.
  HybridLoop(const Device& device, const HybridLoopOptions& options);
  /// Leaves the other without a loop.
  HybridLoop(HybridLoop&&) noexcept;
  /// Leaves the other without a loop.
  HybridLoop& operator=(HybridLoop&&) noexcept;
  /// A loop is one: it is moved, not copied.
  HybridLoop(const HybridLoop&) = delete;
  /// A loop is one: it is moved, not copied.
  HybridLoop& operator=(const HybridLoop&) = delete;
  ~HybridLoop();

  /// Measures at t = k T, updates the controller, and moves the device to (k + 1) T.
  void step() noexcept;

  // The device alone, for a controller that runs elsewhere; options.controller and options.faults then do not act, but
  // for a damper of its own loop, which runs on.
  /// What the encoder gives at k T.
  [[nodiscard]] double measure() noexcept;
  /// Moves the device to (k + 1) T with this force commanded at k T, N or N m: limited, and underway for the delay, as
  /// in step().
  void move(double force) noexcept;

  /// As constructed.
  void reset() noexcept;

  // At the end of the last step, k T:
  [[nodiscard]] std::size_t sample() const noexcept;  ///< k
  [[nodiscard]] double time() const noexcept;         ///< k T, s
  /// Position of the sensed body, m or rad, without the encoder's steps.
  [[nodiscard]] double sensed_position() const noexcept;
  /// Position of a body by its index, m or rad.
  [[nodiscard]] double position(std::size_t body) const noexcept;
  /// Velocity of a body by its index, m/s or rad/s.
  [[nodiscard]] double velocity(std::size_t body) const noexcept;
  /// Whether friction holds that body still.
  [[nodiscard]] bool sticks(std::size_t body) const noexcept;
  /// Now, N or N m.
  [[nodiscard]] double user_force() const noexcept;
  // Within the last step:
  [[nodiscard]] double measured() const noexcept;  ///< what the encoder gave
  [[nodiscard]] double command() const noexcept;   ///< what the controller asked for, limited; of a damper apart, last
  /// Its part that the spring or the relay asked for, not limited, where the damper runs apart; else command().
  [[nodiscard]] double spring_command() const noexcept;
  /// Work of the force that arrived at the actuator since the start, N m: sum of force times travel of the actuated
  /// body (before the actuator's lag; of a transfer function, travel of its output).
  [[nodiscard]] double work() const noexcept;
  /// Stick-slip instants since the start.
  [[nodiscard]] std::size_t friction_events() const noexcept;
  /// Advances in which stick-slip instants were cut off at their cap: 0 in every sound simulation.
  [[nodiscard]] std::size_t overloaded_steps() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace zwidth
