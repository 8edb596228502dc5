#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "simulation/matrix_vector.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

class MotionTangent;

/// A force from outside, at the held body, as the output w0 of w0' = rise w1, w1' = -fall w0: constant (w1 = 0), a ramp
/// (rise 1, fall 0) or a sine (rise = fall = its angular frequency).
struct OutsideForce {
  bool acts = false;
  double rise = 0.0;
  double fall = 0.0;
};

/// The continuous device between two changes of the commanded force, moved exactly.
///
///     x' = A x,   x = (q_0, q_i - q_0, v_i, lagged force, tracked p and q, commanded force, friction forces, w0, w1)
///
/// by e^{Ah} for the recurring lengths h (matrices made once) and by its Taylor series in between: no fixed-step
/// integrator. Positions are kept relative to body 0, so that a link's small extension keeps its digits far from zero.
///
/// Coulomb friction: a sliding body feels -sign(v) F_c; it sticks where its velocity reaches zero and the other forces
/// on it are at most F_c, and breaks away where they exceed it. Every such instant is found as the first root of the
/// Taylor polynomial (isolated by its Bernstein coefficients), not by stepping over it: a step is taken whole only
/// where a bound on the second derivative proves that nothing happens inside. The mass matrix is diagonal, so bodies
/// stick and slip independently of each other at one instant.
///
/// Nothing allocates or throws after construction.
class ContinuousMotion {
 public:
  /// Lengths h > 0 are the ones advance_recurring() takes, by index. Throws Error (invalid_argument) for more than
  /// max_friction_bodies with Coulomb friction.
  ContinuousMotion(const Device& device, OutsideForce outside, std::vector<double> recurring_lengths);

  static constexpr std::size_t max_friction_bodies = 6;
  /// Stick-slip instants within one advance beyond which the rest of it is moved in the modes then reached.
  static constexpr int max_events = 10000;

  /// All states 0, no events counted.
  void reset() noexcept;
  void advance(double duration) noexcept;
  void advance_recurring(std::size_t which) noexcept;

  void set_command(double force) noexcept { state_.data()[command_] = force; }
  void set_outside(double w0, double w1) noexcept;
  /// The same at an instant that may hang on the tangent's parameters.
  void switch_command(double force) noexcept;
  /// Of the actuator, where it has a lag.
  void set_lagged_force(double force) noexcept {
    if (lag_ != no_state) state_.data()[lag_] = force;
  }
  /// Positions and velocities of all bodies. A body at rest sticks if the forces then set allow it.
  void set_motion(const double* positions, const double* velocities) noexcept;

  /// Carries how the motion changes along from then on; the caller keeps it alive. Null: none.
  void set_tangent(MotionTangent* tangent) noexcept { tangent_ = tangent; }

  [[nodiscard]] double command() const noexcept { return state_.data()[command_]; }
  [[nodiscard]] double outside_force() const noexcept { return outside_ == no_state ? 0.0 : state_.data()[outside_]; }
  [[nodiscard]] double position(std::size_t body) const noexcept {
    return body == 0 ? state_.data()[0] : state_.data()[0] + state_.data()[body];
  }
  [[nodiscard]] double velocity(std::size_t body) const noexcept { return state_.data()[bodies_ + body]; }
  /// As the drive reads it.
  [[nodiscard]] double sensed() const noexcept {
    if (tracked_ != no_state) return state_.data()[tracked_];
    return bodies_ > 0 ? position(sensed_) : output();
  }
  /// Position of the actuated body; of a transfer function, its output.
  [[nodiscard]] double actuated() const noexcept { return bodies_ > 0 ? position(actuated_) : output(); }
  [[nodiscard]] bool has_friction() const noexcept { return !friction_.empty(); }
  /// A bound of the device's fastest motion, rad/s: advance() takes that many parts per second.
  [[nodiscard]] double rate() const noexcept;
  [[nodiscard]] std::size_t bodies() const noexcept { return bodies_; }
  [[nodiscard]] bool sticks(std::size_t body) const noexcept;
  /// Stick-slip instants so far, and how many advances hit max_events (0 in every sound simulation).
  [[nodiscard]] std::size_t events() const noexcept { return events_; }
  [[nodiscard]] std::size_t overloaded() const noexcept { return overloaded_; }

  /// Of a recurring length, before an event within it is looked for by a series: down to half the device's fastest
  /// motion.
  [[nodiscard]] std::size_t halvings() const noexcept { return halvings_; }
  /// A step of recurring length, or of half, a quarter, ... of one, in one pattern of sticking bodies.
  struct RecurringStep {
    Eigen::MatrixXd transition;         // e^{Ah}
    std::vector<Eigen::VectorXd> bend;  // per friction body: h²/8 sup |c A² e^{At}|, by component of sizes_
  };
  struct Pattern {
    Eigen::MatrixXd matrix;            // A
    double norm = 0.0;                 // of A, balanced
    std::vector<RecurringStep> steps;  // by length and halvings
  };
  /// Where the state has the command, and the lagged force of an actuator with a lag.
  [[nodiscard]] Eigen::Index command_row() const noexcept { return static_cast<Eigen::Index>(command_); }
  [[nodiscard]] Eigen::Index lag_row() const noexcept { return static_cast<Eigen::Index>(lag_); }
  /// By the bits of the stuck friction bodies.
  [[nodiscard]] const std::vector<Pattern>& patterns() const noexcept { return patterns_; }
  [[nodiscard]] const std::vector<double>& recurring_lengths() const noexcept { return lengths_; }

 private:
  static constexpr double least_halvings = 3.0;
  static constexpr double most_halvings = 10.0;
  static constexpr int degree = 18;  // of the Taylor series: 1/19! < 1e-17 where |A| h <= 1

  /// A body with Coulomb friction.
  struct FrictionBody {
    std::size_t body = 0;
    double limit = 0.0;            // F_c
    std::size_t force = 0;         // index of its friction force in the state
    Eigen::VectorXd other_forces;  // functional: all but friction, at rest
    int direction = 0;             // of sliding; 0: sticks
    bool fresh = false;            // began to slide at this instant: its velocity is exactly 0
  };

  [[nodiscard]] Eigen::MatrixXd matrix_of(const Device& device, OutsideForce outside, unsigned stuck) const;
  [[nodiscard]] static Pattern pattern_of(Eigen::MatrixXd matrix);
  void add_steps(Pattern& pattern, unsigned stuck) const;
  [[nodiscard]] const Pattern& pattern() const noexcept { return patterns_[stuck_]; }
  void advance_part(std::size_t which, std::size_t halvings) noexcept;
  /// `whole_step`: the recurring step of this duration, or no_step.
  void advance_by_series(double duration, std::size_t whole_step) noexcept;
  [[nodiscard]] double output() const noexcept;
  [[nodiscard]] bool nothing_happens(const RecurringStep& step) noexcept;
  void expand(double length) noexcept;                           // series_ of the state over `length`
  void evaluate_series(double fraction) noexcept;                // state_ = series at fraction of its length
  [[nodiscard]] double first_event(std::size_t& body) noexcept;  // fraction of the series' length; above 1: none
  void stick_or_slide(FrictionBody& body) noexcept;              // at velocity 0: stick, or slide with the other forces
  void slide(FrictionBody& body, int direction) noexcept;
  void stick(FrictionBody& body) noexcept;
  void break_away() noexcept;
  [[nodiscard]] double acceleration(const FrictionBody& body) const noexcept;

  static constexpr std::size_t no_state = static_cast<std::size_t>(-1);
  static constexpr std::size_t no_step = static_cast<std::size_t>(-1);

  std::size_t bodies_ = 0;  // 0: a transfer function
  std::size_t sensed_ = 0;
  std::size_t actuated_ = 0;
  Eigen::VectorXd output_;  // of a transfer function
  std::size_t command_ = 0;
  std::size_t lag_ = no_state;
  std::size_t tracked_ = no_state;  // and the one behind; of a transfer function they are among its own
  double bandwidth_ = 0.0;
  std::size_t outside_ = no_state;
  std::size_t size_ = 0;
  std::size_t moving_ = 0;  // of the state, those before the constant ones
  std::vector<FrictionBody> friction_;
  std::vector<double> lengths_;
  std::size_t halvings_ = 0;
  std::vector<Pattern> patterns_;  // by the bits of the stuck friction bodies
  unsigned stuck_ = 0;
  Eigen::VectorXd state_;
  Eigen::VectorXd next_;
  Eigen::VectorXd sizes_;   // of the state's components, velocities less body 0's
  Eigen::MatrixXd series_;  // column k: A^k x h^k / k!
  std::size_t terms_ = 0;   // columns of series_ in use
  MatrixVector multiply_ = nullptr;
  MatrixPartVector multiply_moving_ = nullptr;
  MotionTangent* tangent_ = nullptr;
  std::size_t events_ = 0;
  std::size_t overloaded_ = 0;
};

}  // namespace zwidth::internal
