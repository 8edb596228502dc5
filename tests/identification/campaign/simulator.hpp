#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <numbers>
#include <utility>
#include <vector>

/// A simulator of its own, for records whose truth is known: it shares nothing with the library. Fourth-order Runge-Kutta
/// steps that are fine beside the fastest motion, and end where a body comes to rest, breaks away, or a command arrives.
namespace zwidth::test::simulated {

/// Friction of a body on its guide.
struct Friction {
  double coulomb = 0.0;         ///< N or N m, while it slides
  double stiction = 0.0;        ///< at rest; 0: as while it slides
  double stribeck_speed = 0.0;  ///< at which it has fallen to a third of the way
  double asymmetry = 0.0;       ///< share by which it is larger forwards, smaller backwards
  double ripple = 0.0;          ///< share by which it varies with the position
  double ripple_period = 1.0;   ///< m or rad
  double bristles = 0.0;        ///< N/m or N m/rad: stiffness before it slips (Dahl 1968); 0: rigid
  double quadratic = 0.0;       ///< drag c v|v|, N s^2/m^2
};

struct Mass {
  double mass = 1.0;
  double damping = 0.0;  ///< to ground
  double stiffness = 0.0;
  double cubic = 0.0;  ///< N/m^3: a spring that stiffens
  Friction friction = {};
  bool fixed = false;  ///< held still
};

/// Between two bodies: a spring and a damper, in a gap, beside a spring and damper in series, beside bristles that slip.
struct Joint {
  std::size_t first = 0;
  std::size_t second = 1;
  double stiffness = 0.0;
  double damping = 0.0;
  double gap = 0.0;                 ///< m or rad of free play, all of it
  double relaxing_stiffness = 0.0;  ///< of the branch in series (Maxwell)
  double relaxing_damping = 0.0;
  double friction = 0.0;  ///< N or N m at which the bristles slip
  double bristles = 0.0;  ///< N/m or N m/rad
};

/// From a command to the force on the actuated body: late, limited, without its smallest values, through a lag; the coil of
/// a voltage drive loses `back_emf` of force per speed before the lag.
struct Drive {
  double delay = 0.0;
  double lag = 0.0;
  double saturation = 0.0;  ///< 0: none
  double dead_band = 0.0;
  double back_emf = 0.0;
  double cogging = 0.0;  ///< N or N m, of a pair of sine and cosine of the position
  double cogging_period = 1.0;
  double cogging_phase = 0.0;
  double constant = 0.0;  ///< N or N m
};

struct Plant {
  std::vector<Mass> masses;
  std::vector<Joint> joints;
  Drive drive;
  std::size_t actuated = 0;
  std::size_t sensed = 0;
  double damping_fall = 0.0;  ///< share of all dampings to ground that is lost per second
};

inline constexpr std::size_t most_masses = 4;

class Motion {
 public:
  /// No step is longer than `longest`.
  Motion(const Plant& plant, double longest)
      : plant_(plant), n_(plant.masses.size()), size_(3 * n_ + 1 + 2 * plant.joints.size()), direction_(n_, 0) {
    double fastest = plant.drive.lag > 0.0 ? 1.0 / plant.drive.lag : 0.0;
    for (std::size_t i = 0; i < n_; ++i) {
      const Mass& body = plant.masses[i];
      const Friction& rough = body.friction;
      double stiffness = body.stiffness + rough.bristles;
      double damping = body.damping;
      if (rough.stribeck_speed > 0.0) damping += std::abs(rough.stiction - rough.coulomb) / rough.stribeck_speed;
      if (i == plant.actuated) {
        stiffness += 2.0 * std::numbers::pi * plant.drive.cogging / plant.drive.cogging_period;
        damping += plant.drive.back_emf;
      }
      for (const Joint& joint : plant.joints) {
        if (joint.first != i && joint.second != i) continue;
        stiffness += joint.stiffness + joint.relaxing_stiffness + joint.bristles;
        damping += joint.damping;
        if (joint.relaxing_damping > 0.0)
          fastest = std::max(fastest, joint.relaxing_stiffness / joint.relaxing_damping);
      }
      fastest = std::max({fastest, std::sqrt(2.0 * stiffness / body.mass), 2.0 * damping / body.mass});
    }
    constexpr double share_of_fastest = 0.04;
    longest_ = fastest > 0.0 ? std::min(longest, share_of_fastest / fastest) : longest;
  }

  /// What the controller asks for from now on; it acts after the drive's delay.
  void command(double force) {
    const Drive& drive = plant_.drive;
    double acts = std::copysign(std::max(0.0, std::abs(force) - drive.dead_band), force);
    if (drive.saturation > 0.0) acts = std::clamp(acts, -drive.saturation, drive.saturation);
    coming_.emplace_back(time_ + drive.delay, acts + drive.constant);
    take_command();
  }

  void advance(double duration) {
    const double end = time_ + duration;
    while (time_ < end) {
      const double until = coming_.empty() ? end : std::min(end, coming_.front().first);
      move(until - time_);
      time_ = until;
      take_command();
    }
  }

  [[nodiscard]] double position(std::size_t body) const { return state_[body]; }
  [[nodiscard]] double velocity(std::size_t body) const { return state_[n_ + body]; }
  [[nodiscard]] bool sticks(std::size_t body) const { return holds(body) && direction_[body] == 0; }
  void place(std::size_t body, double position, double velocity) {
    state_[body] = position;
    state_[n_ + body] = velocity;
    direction_[body] = velocity > 0.0 ? 1 : velocity < 0.0 ? -1 : 0;
  }

  /// Of the motion, the springs and the bristles.
  [[nodiscard]] double energy() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < n_; ++i) {
      const Mass& body = plant_.masses[i];
      const double square = state_[i] * state_[i];
      sum += 0.5 * body.mass * state_[n_ + i] * state_[n_ + i] + 0.5 * body.stiffness * square;
      sum += 0.25 * body.cubic * square * square + 0.5 * body.friction.bristles * std::pow(state_[bristle(i)], 2);
    }
    for (std::size_t j = 0; j < plant_.joints.size(); ++j) {
      const Joint& joint = plant_.joints[j];
      const double apart = state_[joint.first] - state_[joint.second];
      sum += 0.5 * joint.stiffness * std::pow(beyond(apart, joint.gap), 2);
      sum += 0.5 * joint.relaxing_stiffness * std::pow(apart - state_[relaxed(j)], 2);
      sum += 0.5 * joint.bristles * std::pow(state_[slipped(j)], 2);
    }
    return sum;
  }

 private:
  /// Positions, velocities, force of the drive, bristles of the bodies, what has relaxed and slipped in the joints.
  using State = std::array<double, 3 * most_masses + 1 + 2 * most_masses>;
  using Forces = std::array<double, most_masses>;

  [[nodiscard]] std::size_t bristle(std::size_t body) const { return 2 * n_ + 1 + body; }
  [[nodiscard]] std::size_t relaxed(std::size_t joint) const { return 3 * n_ + 1 + 2 * joint; }
  [[nodiscard]] std::size_t slipped(std::size_t joint) const { return 3 * n_ + 2 + 2 * joint; }
  [[nodiscard]] static double beyond(double apart, double gap) {
    return apart > 0.5 * gap ? apart - 0.5 * gap : apart < -0.5 * gap ? apart + 0.5 * gap : 0.0;
  }
  /// Rigid friction, with rest as a state of its own.
  [[nodiscard]] bool holds(std::size_t body) const {
    const Friction& rough = plant_.masses[body].friction;
    return rough.coulomb > 0.0 && !(rough.bristles > 0.0);
  }

  void take_command() {
    while (!coming_.empty() && coming_.front().first <= time_) {
      command_ = coming_.front().second;
      coming_.pop_front();
    }
    if (!(plant_.drive.lag > 0.0)) state_[2 * n_] = command_;
  }

  [[nodiscard]] double level(std::size_t body, int direction, double position, double speed) const {
    const Friction& rough = plant_.masses[body].friction;
    double force = rough.coulomb;
    if (rough.stiction > 0.0) {
      force += (rough.stiction - rough.coulomb) *
               (rough.stribeck_speed > 0.0 ? std::exp(-std::pow(speed / rough.stribeck_speed, 2)) : speed == 0.0);
    }
    force *= 1.0 + rough.asymmetry * direction;
    if (rough.ripple != 0.0) {
      force *= 1.0 + rough.ripple * std::sin(2.0 * std::numbers::pi * position / rough.ripple_period);
    }
    return force;
  }

  /// All forces on each body but its rigid friction.
  [[nodiscard]] Forces forces(const State& s, double time) const {
    Forces sum{};
    const double warm = std::max(0.0, 1.0 - plant_.damping_fall * time);
    for (std::size_t i = 0; i < n_; ++i) {
      const Mass& body = plant_.masses[i];
      const double v = s[n_ + i];
      sum[i] = -warm * body.damping * v - body.stiffness * s[i] - body.friction.quadratic * v * std::abs(v) -
               body.friction.bristles * s[bristle(i)];
      if (body.cubic > 0.0) sum[i] -= body.cubic * s[i] * s[i] * s[i];
    }
    const Drive& drive = plant_.drive;
    double& driven = sum[plant_.actuated];
    driven += s[2 * n_];
    if (!(drive.lag > 0.0)) driven -= drive.back_emf * s[n_ + plant_.actuated];
    if (drive.cogging > 0.0) {
      driven -= drive.cogging *
                std::sin(2.0 * std::numbers::pi * s[plant_.actuated] / drive.cogging_period + drive.cogging_phase);
    }
    for (std::size_t j = 0; j < plant_.joints.size(); ++j) {
      const Joint& joint = plant_.joints[j];
      const double apart = s[joint.first] - s[joint.second];
      const double wound = beyond(apart, joint.gap);
      double pull =
          joint.stiffness * wound + joint.relaxing_stiffness * (apart - s[relaxed(j)]) + joint.bristles * s[slipped(j)];
      if (!(joint.gap > 0.0) || wound != 0.0) pull += joint.damping * (s[n_ + joint.first] - s[n_ + joint.second]);
      sum[joint.first] -= pull;
      sum[joint.second] += pull;
    }
    return sum;
  }

  [[nodiscard]] static double bristle_rate(double speed, double bent, double stiffness, double friction) {
    return stiffness > 0.0 ? speed - std::abs(speed) * stiffness * bent / friction : 0.0;
  }

  /// Bristles that bend fast settle fast.
  [[nodiscard]] double longest_of_bristles() const {
    double fastest = 1e-9;
    for (std::size_t i = 0; i < n_; ++i) {
      const Friction& rough = plant_.masses[i].friction;
      if (rough.bristles > 0.0) fastest = std::max(fastest, std::abs(state_[n_ + i]) * rough.bristles / rough.coulomb);
    }
    for (const Joint& joint : plant_.joints) {
      const double speed = std::abs(state_[n_ + joint.first] - state_[n_ + joint.second]);
      if (joint.bristles > 0.0) fastest = std::max(fastest, speed * joint.bristles / joint.friction);
    }
    constexpr double share_of_fastest = 0.2;
    return share_of_fastest / fastest;
  }

  [[nodiscard]] State slope(const State& s, double time) const {
    State d{};
    const Forces sum = forces(s, time);
    for (std::size_t i = 0; i < n_; ++i) {
      const Mass& body = plant_.masses[i];
      if (body.fixed || sticks(i)) continue;
      const double v = s[n_ + i];
      d[i] = v;
      const double friction = holds(i) ? direction_[i] * level(i, direction_[i], s[i], v) : 0.0;
      d[n_ + i] = (sum[i] - friction) / body.mass;
      d[bristle(i)] = bristle_rate(v, s[bristle(i)], body.friction.bristles, body.friction.coulomb);
    }
    const Drive& drive = plant_.drive;
    if (drive.lag > 0.0) {
      d[2 * n_] = (command_ - drive.back_emf * s[n_ + plant_.actuated] - s[2 * n_]) / drive.lag;
    }
    for (std::size_t j = 0; j < plant_.joints.size(); ++j) {
      const Joint& joint = plant_.joints[j];
      if (joint.relaxing_damping > 0.0) {
        const double apart = s[joint.first] - s[joint.second];
        d[relaxed(j)] = joint.relaxing_stiffness / joint.relaxing_damping * (apart - s[relaxed(j)]);
      }
      d[slipped(j)] =
          bristle_rate(s[n_ + joint.first] - s[n_ + joint.second], s[slipped(j)], joint.bristles, joint.friction);
    }
    return d;
  }

  [[nodiscard]] State stepped(const State& s, double time, double h) const {
    const auto plus = [&](const State& d, double by) {
      State moved = s;
      for (std::size_t i = 0; i < size_; ++i) moved[i] += by * d[i];
      return moved;
    };
    const State a = slope(s, time);
    const State b = slope(plus(a, 0.5 * h), time + 0.5 * h);
    const State c = slope(plus(b, 0.5 * h), time + 0.5 * h);
    const State d = slope(plus(c, h), time + h);
    State moved = s;
    for (std::size_t i = 0; i < size_; ++i) moved[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
    return moved;
  }

  [[nodiscard]] bool breaks_away(std::size_t body, double push) const {
    return std::abs(push) > level(body, push > 0.0 ? 1 : -1, state_[body], 0.0);
  }

  /// The body whose sliding or sticking ends before this state; n_: none.
  [[nodiscard]] std::size_t ended(const State& s, double time) const {
    Forces sum{};
    bool known = false;
    for (std::size_t i = 0; i < n_; ++i) {
      if (!holds(i) || plant_.masses[i].fixed) continue;
      if (direction_[i] != 0) {
        if (direction_[i] * s[n_ + i] < 0.0) return i;
        continue;
      }
      if (!known) sum = forces(s, time);
      known = true;
      if (breaks_away(i, sum[i])) return i;
    }
    return n_;
  }

  void rest_or_slide(std::size_t body, double time) {
    state_[n_ + body] = 0.0;
    const double push = forces(state_, time)[body];
    direction_[body] = !breaks_away(body, push) ? 0 : push > 0.0 ? 1 : -1;
  }

  void move(double duration) {
    double time = time_;
    for (std::size_t i = 0; i < n_; ++i) {
      if (sticks(i) && !plant_.masses[i].fixed) rest_or_slide(i, time);
    }
    const auto steps = std::max(1.0, std::ceil(duration / longest_ - 1e-9));
    double left = duration;
    while (left > 1e-13) {
      const double h = std::min({left, duration / steps, longest_of_bristles()});
      const State next = stepped(state_, time, h);
      if (ended(next, time + h) == n_) {
        state_ = next;
        left -= h;
        time += h;
        continue;
      }
      double low = 0.0;
      double high = h;
      for (int halving = 0; halving < 40; ++halving) {
        const double middle = 0.5 * (low + high);
        (ended(stepped(state_, time, middle), time + middle) == n_ ? low : high) = middle;
      }
      const State there = stepped(state_, time, high);
      const std::size_t body = ended(there, time + high);
      state_ = there;
      left -= high;
      time += high;
      if (body < n_) rest_or_slide(body, time);
    }
  }

  const Plant plant_;
  std::size_t n_;
  std::size_t size_;
  State state_{};
  std::vector<int> direction_;                      ///< of the sliding; 0: at rest
  std::deque<std::pair<double, double>> coming_{};  ///< when a command acts, and which
  double command_ = 0.0;
  double time_ = 0.0;
  double longest_ = 0.0;
};

}  // namespace zwidth::test::simulated
