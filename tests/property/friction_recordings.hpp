#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "property/random_recordings.hpp"

namespace zwidth::test {

namespace detail {
inline double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double each : values) most = std::max(most, std::abs(each));
  return most;
}
}  // namespace detail

/// A chain with dry friction under held forces, by fourth-order Runge-Kutta steps that end where a body comes to rest or
/// breaks away (found by bisection). Shares nothing with the library's motion.
class FrictionChain {
 public:
  explicit FrictionChain(const DeviceParameters& device)
      : device_(device), n_(device.bodies.size()), direction_(n_, 0) {
    double fastest = device.actuator.time_constant > 0.0 ? 1.0 / device.actuator.time_constant : 1.0;
    for (const Link& link : device.links) {
      const double mass = std::min(device.bodies[link.first].mass, device.bodies[link.second].mass);
      fastest = std::max({fastest, std::sqrt(2.0 * link.stiffness / mass), 2.0 * link.damping / mass});
    }
    longest_ = std::min(0.04 / fastest, device.loop.sampling_period);
  }

  std::vector<double> positions(const std::vector<double>& force) {
    const double period = device_.loop.sampling_period;
    const auto whole = static_cast<std::size_t>(std::floor(device_.loop.delay / period));
    const double within = device_.loop.delay - static_cast<double>(whole) * period;
    std::vector<double> sensed;
    const auto at = [&](std::size_t k, std::size_t late) { return k < late ? 0.0 : force[k - late]; };
    for (std::size_t k = 0; k < force.size(); ++k) {
      sensed.push_back(state_[device_.loop.sensed]);
      move(at(k, whole + 1), within);
      move(at(k, whole), period - within);
    }
    return sensed;
  }

 private:
  static constexpr std::size_t most_bodies = 3;
  using State = std::array<double, 2 * most_bodies + 1>;  // positions, velocities, force of the actuator

  [[nodiscard]] double others(const State& s, std::size_t i) const {
    double force = -device_.bodies[i].damping * s[n_ + i] - device_.bodies[i].stiffness * s[i];
    if (i == device_.loop.actuated) force += s[2 * n_];
    for (const Link& link : device_.links) {
      if (link.first != i && link.second != i) continue;
      const double pull =
          link.stiffness * (s[link.first] - s[link.second]) + link.damping * (s[n_ + link.first] - s[n_ + link.second]);
      force += link.first == i ? -pull : pull;
    }
    return force;
  }

  [[nodiscard]] State slope(const State& s) const {
    State d{};
    for (std::size_t i = 0; i < n_; ++i) {
      d[i] = s[n_ + i];
      const double friction = device_.bodies[i].coulomb;
      if (friction > 0.0 && direction_[i] == 0) continue;  // sticks
      d[n_ + i] = (others(s, i) - direction_[i] * friction) / device_.bodies[i].mass;
    }
    const double lag = device_.actuator.time_constant;
    if (lag > 0.0) d[2 * n_] = (command_ - s[2 * n_]) / lag;
    return d;
  }

  [[nodiscard]] State stepped(const State& s, double h) const {
    const auto plus = [&](const State& d, double by) {
      State moved = s;
      for (std::size_t i = 0; i < s.size(); ++i) moved[i] += by * d[i];
      return moved;
    };
    const State a = slope(s);
    const State b = slope(plus(a, 0.5 * h));
    const State c = slope(plus(b, 0.5 * h));
    const State d = slope(plus(c, h));
    State moved = s;
    for (std::size_t i = 0; i < s.size(); ++i) moved[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
    return moved;
  }

  /// The body whose sliding or sticking ends before this state; n_: none.
  [[nodiscard]] std::size_t ended(const State& s) const {
    for (std::size_t i = 0; i < n_; ++i) {
      const double friction = device_.bodies[i].coulomb;
      if (!(friction > 0.0)) continue;
      if (direction_[i] != 0 ? direction_[i] * s[n_ + i] < 0.0 : std::abs(others(s, i)) > friction) return i;
    }
    return n_;
  }

  void stick_or_slide(std::size_t i) {
    state_[n_ + i] = 0.0;
    const double drive = others(state_, i);
    direction_[i] = std::abs(drive) <= device_.bodies[i].coulomb ? 0 : drive > 0.0 ? 1 : -1;
  }

  void move(double command, double duration) {
    command_ = command;
    if (!(device_.actuator.time_constant > 0.0)) state_[2 * n_] = command;
    for (std::size_t i = 0; i < n_; ++i) {
      if (device_.bodies[i].coulomb > 0.0 && direction_[i] == 0) stick_or_slide(i);
    }
    double left = duration;
    while (left > 1e-15) {
      const double h = std::min(left, longest_);
      State next = stepped(state_, h);
      const std::size_t body = ended(next);
      if (body == n_) {
        state_ = next;
        left -= h;
        continue;
      }
      double low = 0.0;
      double high = h;
      for (int halving = 0; halving < 40; ++halving) {
        const double middle = 0.5 * (low + high);
        (ended(stepped(state_, middle)) == n_ ? low : high) = middle;
      }
      next = stepped(state_, high);
      const std::size_t first = ended(next);
      state_ = next;
      left -= high;
      if (first == n_) continue;
      if (direction_[first] != 0) {
        stick_or_slide(first);
      } else {
        direction_[first] = others(state_, first) > 0.0 ? 1 : -1;
      }
    }
  }

  const DeviceParameters& device_;
  std::size_t n_;
  State state_{};
  std::vector<int> direction_;
  double command_ = 0.0;
  double longest_ = 0.0;
};

/// Recordings of one device with friction of 1 to 20 % of the force's amplitude, encoder and noise; the truth is known.
struct FrictionRecordings {
  std::uint64_t seed = 0;
  std::vector<Recording> recordings;  ///< one, or two of which the second has 0.4 of the force
  DeviceParameters truth;
  DeviceParameters structure;  ///< placeholders for every number
  double stiffness = 0.0;      ///< K_CR of the truth without friction
  double limiting_hz = 0.0;
  double friction_share = 0.0;
  std::string what;
};

inline FrictionRecordings friction_recordings(std::uint64_t seed) {
  for (std::uint64_t attempt = 0;; ++attempt) {
    detail::Draw draw(1000003 * seed + attempt);
    FrictionRecordings made;
    made.seed = seed;
    const std::size_t bodies = draw.chance(0.3) ? 1 : 2;
    DeviceParameters truth = detail::random_chain(draw, bodies);
    truth.loop.sampling_period = 1e-3;
    const CriticalStiffness critical = critical_stiffness(Device(truth));
    const double highest_hz = draw.uniform(80.0, 300.0);
    if (!critical.limit || !(critical.stiffness > 0.0)) continue;
    made.limiting_hz = critical.limit->frequency / (2.0 * std::numbers::pi);
    constexpr double lowest_hz = 0.5;
    if (made.limiting_hz > 0.8 * highest_hz || made.limiting_hz < 2.0 * lowest_hz) continue;
    made.stiffness = critical.stiffness;
    made.friction_share = draw.logarithmic(0.01, 0.2);
    const std::size_t where = bodies == 1 ? 0 : draw.below(3);  // 2: half on each
    ExcitationOptions excitation;
    excitation.kind =
        std::array{ExcitationKind::multisine, ExcitationKind::noise, ExcitationKind::logarithmic_chirp}[draw.below(3)];
    excitation.amplitude = draw.logarithmic(1.0, 20.0);
    excitation.duration = 20.0;
    excitation.rate = 1000.0;
    excitation.lowest_hz = lowest_hz;
    excitation.highest_hz = highest_hz;
    excitation.periods = 5;
    excitation.seed = seed;
    const double friction = made.friction_share * excitation.amplitude;
    for (std::size_t i = 0; i < bodies; ++i) {
      if (where == 2 || where == i) truth.bodies[i].coulomb = where == 2 ? 0.5 * friction : friction;
    }
    const bool two = draw.chance(0.5);
    for (const double share : two ? std::vector{1.0, 0.4} : std::vector{1.0}) {
      std::vector<double> force = excite(excitation).samples;
      for (double& each : force) each *= share;
      std::vector<double> real = force;
      const double disturbance = draw.logarithmic(0.0005, 0.01) * crest_factor(force).rms;
      const double constant = 0.2 * friction * draw.uniform(-1.0, 1.0);
      for (double& each : real) each += disturbance * draw.normal() + constant;
      std::vector<double> position = FrictionChain(truth).positions(real);
      double moved = 0.0;
      for (std::size_t k = 1; k < position.size(); ++k) moved += std::pow(position[k] - position[k - 1], 2);
      moved = std::sqrt(moved / static_cast<double>(position.size()));
      const double resolution = moved * draw.logarithmic(0.005, 0.2);
      const double noise = moved * draw.logarithmic(0.002, 0.05);
      for (double& each : position) each = resolution * std::round((each + noise * draw.normal()) / resolution);
      made.recordings.push_back({"seed " + std::to_string(seed), 1e-3, {{"force", force}, {"position", position}}, {}});
    }
    made.truth = truth;
    made.structure.name = "structure";
    for (std::size_t i = 0; i < bodies; ++i) {
      made.structure.bodies.push_back({"body" + std::to_string(i), 1.0, 1.0, 0.0, 0.0});
      if (i > 0) made.structure.links.push_back({i - 1, i, 1.0, 1.0});
    }
    made.structure.loop = {0, 0, bodies - 1, 1e-3, 0.0};
    made.what = std::to_string(bodies) + (bodies == 1 ? " body, " : " bodies, ") +
                std::to_string(made.recordings.size()) + " recordings, friction " +
                std::to_string(made.friction_share) + " on " + std::to_string(where);
    return made;
  }
}

}  // namespace zwidth::test
