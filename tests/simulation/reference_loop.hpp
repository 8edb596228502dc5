#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <cstddef>
#include <deque>
#include <numbers>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"

namespace zwidth::test {

// Everything is promoted to long double here, on purpose.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdouble-promotion"

// The sampled loop by another route: Newton's equations in absolute positions, integrated by Boost.Odeint's
// Runge-Kutta-Fehlberg 7(8) in long double over small parts of a period; stick-slip instants by bisection within a
// part; controller and forces under way written out from their definitions. Friction and user force included, faults
// not.
class ReferenceLoop {
 public:
  using Real = long double;
  using State = std::vector<Real>;  // positions, velocities, lagged force

  ReferenceLoop(const DeviceParameters& device, const HybridLoopOptions& options)
      : device_(device), options_(options), bodies_(device.bodies.size()), directions_(bodies_, 0) {
    state_.assign(2 * bodies_ + 1, 0.0L);
    for (std::size_t i = 0; i < bodies_; ++i) {
      if (!options.initial_position.empty()) state_[i] = options.initial_position[i];
      if (!options.initial_velocity.empty()) state_[bodies_ + i] = options.initial_velocity[i];
    }
    Real rate = 20.0L / period();
    for (std::size_t i = 0; i < bodies_; ++i) {
      Real stiffness = device.bodies[i].stiffness + (i == device.loop.held ? device.user.stiffness : 0.0L);
      Real damping = device.bodies[i].damping + (i == device.loop.held ? device.user.damping : 0.0L);
      for (const Link& link : device.links) {
        if (link.first != i && link.second != i) continue;
        stiffness += link.stiffness;
        damping += link.damping;
      }
      rate = std::max({rate, 30.0L * std::sqrt(stiffness / mass(i)), 30.0L * damping / mass(i)});
    }
    if (device.actuator.time_constant > 0.0) rate = std::max(rate, 30.0L / device.actuator.time_constant);
    part_ = 1.0L / rate;
    for (std::size_t i = 0; i < bodies_; ++i) directions_[i] = has_friction(i) ? sign(state_[bodies_ + i]) : 0;
    settle_modes();
  }

  void step() {
    const Real start = static_cast<Real>(sample_) * period();
    const Real end = start + period();
    const double resolution = device_.sensor.resolution;
    double measured = static_cast<double>(state_[device_.loop.sensed]);
    if (resolution > 0.0) measured = resolution * std::floor(measured / resolution + 0.5);
    const double force = control(measured);
    const double limit = device_.actuator.force_limit.value_or(HUGE_VAL);
    under_way_.push_back({start + device_.loop.delay, std::clamp(force, -limit, limit)});
    time_ = start;
    while (time_ < end) {
      Real next = end;
      // Within rounding of now is now.
      const Real now = time_ + 1e-12L * period();
      while (!under_way_.empty() && under_way_.front().arrival <= now) {
        command_ = under_way_.front().force;
        under_way_.pop_front();
        settle_modes();
      }
      if (!under_way_.empty()) next = std::min(next, under_way_.front().arrival);
      while (next_change_of_user() <= now) change_user();
      next = std::min(next, next_change_of_user());
      move_to(next);
    }
    ++sample_;
  }

  [[nodiscard]] double position(std::size_t body) const { return static_cast<double>(state_[body]); }
  [[nodiscard]] double velocity(std::size_t body) const { return static_cast<double>(state_[bodies_ + body]); }
  [[nodiscard]] bool sticks(std::size_t body) const { return has_friction(body) && directions_[body] == 0; }
  [[nodiscard]] std::size_t events() const { return events_; }

 private:
  struct Force {
    Real arrival = 0.0L;
    Real force = 0.0L;
  };

  [[nodiscard]] Real period() const { return device_.loop.sampling_period; }
  [[nodiscard]] bool has_friction(std::size_t body) const { return device_.bodies[body].coulomb > 0.0; }
  static int sign(Real value) { return value > 0.0L ? 1 : value < 0.0L ? -1 : 0; }

  [[nodiscard]] Real mass(std::size_t body) const {
    return device_.bodies[body].mass + (body == device_.loop.held ? device_.user.mass : 0.0);
  }

  [[nodiscard]] Real user_force(Real time) const {
    const UserForce& user = options_.user_force;
    const Real since = time - user.start;
    if (!user_acts_) return 0.0L;
    switch (user.kind) {
      case UserForce::Kind::none:
        return 0.0L;
      case UserForce::Kind::step:
        return user.amplitude;
      case UserForce::Kind::ramp:
        return user.amplitude * since;
      case UserForce::Kind::sine:
        return user.amplitude * std::sin(user.frequency * since);
      case UserForce::Kind::recorded: {
        if (user_sample_ + 1 >= user.samples.size()) return 0.0L;
        const Real part = since / user.period - static_cast<Real>(user_sample_);
        return user.samples[user_sample_] + part * (user.samples[user_sample_ + 1] - user.samples[user_sample_]);
      }
    }
    return 0.0L;
  }

  [[nodiscard]] Real next_change_of_user() const {
    const UserForce& user = options_.user_force;
    if (user.kind == UserForce::Kind::none) return HUGE_VALL;
    if (!user_acts_) return user.start;
    if (user.kind != UserForce::Kind::recorded || user_sample_ + 1 >= user.samples.size()) return HUGE_VALL;
    return user.start + static_cast<Real>(user_sample_ + 1) * user.period;
  }

  void change_user() {
    if (user_acts_) ++user_sample_;
    user_acts_ = true;
  }

  double control(double measured) {
    const ControllerOptions& wall = options_.controller;
    if (wall.kind != ControllerOptions::Kind::wall) return 0.0;
    const double rate = sample_ == 0 ? 0.0 : (measured - previous_) / static_cast<double>(period());
    const double keep =
        wall.velocity_filter_hz > 0.0
            ? std::exp(-2.0 * std::numbers::pi * wall.velocity_filter_hz * static_cast<double>(period()))
            : 0.0;
    filtered_ = keep * filtered_ + (1.0 - keep) * rate;
    previous_ = measured;
    const double depth = measured - wall.position;
    const double force = -wall.stiffness * depth - wall.damping * filtered_;
    if (wall.contact == ControllerOptions::Contact::bilateral) return force;
    return depth > 0.0 ? std::min(force, 0.0) : 0.0;
  }

  // All forces on a body but its Coulomb friction.
  [[nodiscard]] Real other_forces(std::size_t body, const State& x, Real time) const {
    const Body& parameters = device_.bodies[body];
    const Real q = x[body];
    const Real v = x[bodies_ + body];
    Real force = -parameters.damping * v - parameters.stiffness * q;
    if (body == device_.loop.held) {
      force += user_force(time) - device_.user.damping * v - device_.user.stiffness * q;
    }
    for (const Link& link : device_.links) {
      if (link.first != body && link.second != body) continue;
      const std::size_t other = link.first == body ? link.second : link.first;
      force -= link.stiffness * (q - x[other]) + link.damping * (v - x[bodies_ + other]);
    }
    if (body == device_.loop.actuated) force += device_.actuator.time_constant > 0.0 ? x.back() : command_;
    return force;
  }

  void derivative(const State& x, State& change, Real time) const {
    for (std::size_t i = 0; i < bodies_; ++i) {
      change[i] = x[bodies_ + i];
      const Real friction = has_friction(i) ? -directions_[i] * static_cast<Real>(device_.bodies[i].coulomb) : 0.0L;
      change[bodies_ + i] = sticks(i) ? 0.0L : (other_forces(i, x, time) + friction) / mass(i);
    }
    change.back() =
        device_.actuator.time_constant > 0.0 ? (command_ - x.back()) / device_.actuator.time_constant : 0.0L;
  }

  [[nodiscard]] State moved(Real duration) const {
    State x = state_;
    boost::numeric::odeint::runge_kutta_fehlberg78<State, Real> stepper;
    stepper.do_step([this](const State& at, State& change, Real time) { derivative(at, change, time); }, x, time_,
                    duration);
    return x;
  }

  // How far a body is from its next stick-slip instant: negative behind it.
  [[nodiscard]] Real distance_to_event(std::size_t body, const State& x, Real time) const {
    if (directions_[body] != 0) return directions_[body] * x[bodies_ + body];
    return device_.bodies[body].coulomb - std::abs(other_forces(body, x, time));
  }

  // Whether a body has its event in the part that ends at x. One that has only just begun to slide has none.
  [[nodiscard]] bool passes_event(std::size_t body, const State& x, Real time) const {
    return has_friction(body) && distance_to_event(body, x, time) < 0.0L;
  }

  void settle_modes() {
    for (std::size_t i = 0; i < bodies_; ++i) {
      if (!has_friction(i) || state_[bodies_ + i] != 0.0L) continue;
      const Real others = other_forces(i, state_, time_);
      directions_[i] = std::abs(others) > device_.bodies[i].coulomb ? sign(others) : 0;
    }
  }

  void move_to(Real end) {
    settle_modes();
    while (time_ < end) {
      const Real duration = std::min(part_, end - time_);
      const State after = moved(duration);
      std::size_t met = bodies_;
      Real first = duration;
      for (std::size_t i = 0; i < bodies_; ++i) {
        if (!passes_event(i, after, time_ + duration)) continue;
        Real before = 0.0L;
        Real behind = duration;
        for (int halving = 0; halving < 80; ++halving) {
          const Real middle = 0.5L * (before + behind);
          (passes_event(i, moved(middle), time_ + middle) ? behind : before) = middle;
        }
        if (met < bodies_ && behind >= first) continue;
        met = i;
        first = behind;
      }
      if (met == bodies_) {
        state_ = after;
        time_ = duration < part_ ? end : time_ + duration;
      } else {
        state_ = moved(first);
        time_ += first;
        const bool was_stuck = directions_[met] == 0;
        state_[bodies_ + met] = 0.0L;
        const Real others = other_forces(met, state_, time_);
        directions_[met] = was_stuck || std::abs(others) > device_.bodies[met].coulomb ? sign(others) : 0;
        ++events_;
      }
    }
  }

  DeviceParameters device_;
  HybridLoopOptions options_;
  std::size_t bodies_;
  State state_;
  std::vector<int> directions_;  // of sliding; 0: sticks (or has no friction)
  Real part_ = 0.0L;
  Real time_ = 0.0L;
  Real command_ = 0.0L;
  std::deque<Force> under_way_;
  bool user_acts_ = false;
  std::size_t user_sample_ = 0;
  std::size_t sample_ = 0;
  double previous_ = 0.0;
  double filtered_ = 0.0;
  std::size_t events_ = 0;
};

#pragma GCC diagnostic pop

/// Steps both 1000 times: every body's position and velocity within `tolerance` of its largest, sticking at the same
/// samples.
inline void expect_same_motion(HybridLoop& ours, ReferenceLoop& reference, std::size_t bodies, double tolerance) {
  std::vector<double> largest(2 * bodies, 0.0);
  std::vector<double> worst(2 * bodies, 0.0);
  for (int k = 0; k < 1000; ++k) {
    ours.step();
    reference.step();
    for (std::size_t i = 0; i < bodies; ++i) {
      largest[i] = std::max(largest[i], std::abs(reference.position(i)));
      worst[i] = std::max(worst[i], std::abs(ours.position(i) - reference.position(i)));
      largest[bodies + i] = std::max(largest[bodies + i], std::abs(reference.velocity(i)));
      worst[bodies + i] = std::max(worst[bodies + i], std::abs(ours.velocity(i) - reference.velocity(i)));
      EXPECT_EQ(ours.sticks(i), reference.sticks(i)) << "body " << i << " at sample " << k + 1;
    }
  }
  for (std::size_t i = 0; i < worst.size(); ++i) {
    EXPECT_GT(largest[i], 0.0) << "state " << i;
    EXPECT_LE(worst[i], tolerance * largest[i]) << "state " << i;
  }
}

}  // namespace zwidth::test
