#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "stability/loop/damper_response.hpp"
#include "stability/second_route/scheduled_loop.hpp"
#include "stability/users/termination_discs.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/worst_user.hpp"

namespace zwidth::test {

using Reactances = std::vector<internal::TerminationDiscs::Alias>;  // jX that a user has there

// What a lossless user must have at the aliases of one frequency of the spring's band, at most as many as asked for, to put the
// plant that the spring sees on the boundary of its disc, towards -1/K. The damper runs faster, by whole periods apart; its
// discs, their Moebius maps and their sum are computed here anew.
class TwoRateReactances {
 public:
  explicit TwoRateReactances(const Device& device)
      : discs_(with_loop_of_damper(device)),
        spring_period_(device.loop().sampling_period),
        damper_(damper_timing(device.loop())),
        gains_{device.parameters().wall.damping, device.parameters().wall.velocity_filter_hz},
        steps_(static_cast<int>(std::lround(spring_period_ / damper_.sampling_period))),
        later_(std::round((device.loop().delay - damper_.delay) / damper_.sampling_period)) {}

  [[nodiscard]] Reactances towards(double stiffness, double frequency, std::size_t most) const {
    std::vector<Part> parts;
    std::complex<double> centre;
    for (int alias = -(steps_ - 1) / 2; alias <= steps_ / 2; ++alias) {
      parts.push_back(part(frequency + 2.0 * std::numbers::pi * alias / spring_period_));
      centre += parts.back().centre;
    }
    const double direction = std::arg(-1.0 / stiffness - centre);
    std::vector<Weighed> all;
    for (const Part& each : parts) {
      // q of the closed disc and p = q/(1 - g q) of the open one; at a negative frequency all is conjugate.
      const std::complex<double> closed = (each.centre + std::polar(each.radius, direction)) / each.weight;
      const std::complex<double> seen = each.is_negative ? std::conj(closed) : closed;
      const std::complex<double> open = seen / (1.0 - each.damper * seen);
      const double towards = std::arg(open - each.disc.centre);
      for (int k = -most_aliases; k <= most_aliases; ++k) {
        const auto alias = discs_.alias(each.frequency, k, towards);
        all.push_back({alias, each.radius * alias.radius / each.disc.radius});
      }
    }
    std::ranges::sort(all, [](const Weighed& a, const Weighed& b) { return a.weight > b.weight; });
    Reactances kept;
    for (const Weighed& each : all) {
      const double at = each.alias.frequency;
      // The two of a pair at Nyquist are one frequency.
      const bool is_there =
          std::ranges::any_of(kept, [&](const auto& other) { return std::abs(other.frequency - at) <= 1e-9 * at; });
      if (!is_there && kept.size() < most) kept.push_back(each.alias);
    }
    return kept;
  }

 private:
  static constexpr int most_aliases = 40;
  struct Part {
    double frequency = 0.0;
    bool is_negative = false;
    internal::TerminationDiscs::Disc disc;
    std::complex<double> damper;  // g = B v
    std::complex<double> weight;  // h(z) z^-m/N
    std::complex<double> centre;  // of the closed disc, weighed
    double radius = 0.0;
  };
  struct Weighed {
    internal::TerminationDiscs::Alias alias;
    double weight = 0.0;
  };

  [[nodiscard]] Part part(double frequency) const {
    Part part;
    const double nyquist = std::numbers::pi / damper_.sampling_period;
    if (frequency > nyquist) frequency -= 2.0 * nyquist;
    part.is_negative = frequency < 0.0;
    part.frequency = std::min(std::abs(frequency), nyquist);
    part.disc = discs_.at(part.frequency);
    part.damper = internal::damper_response(gains_, damper_.sampling_period, part.frequency);
    const std::complex<double> back = std::polar(1.0, -part.frequency * damper_.sampling_period);
    const std::complex<double> held = (1.0 - std::pow(back, steps_)) / (1.0 - back);
    part.weight = held * std::pow(back, later_) / static_cast<double>(steps_);
    if (part.is_negative) part.weight = std::conj(part.weight);
    const double divisor =
        1.0 + 2.0 * (part.damper * part.disc.centre).real() + std::norm(part.damper) * part.disc.power;
    std::complex<double> closed = (part.disc.centre + std::conj(part.damper) * part.disc.power) / divisor;
    if (part.is_negative) closed = std::conj(closed);
    part.centre = part.weight * closed;
    part.radius = std::abs(part.weight) * part.disc.radius / divisor;
    return part;
  }

  internal::TerminationDiscs discs_;
  double spring_period_;
  DamperTiming damper_;
  VirtualDamper gains_;
  int steps_;
  double later_;
};

// The Foster network of those reactances, an absorber beside each: X = sum of r w/(p² - w²), p² = w² + r w/X with what the
// others leave of X, r = share |X| w.
inline std::optional<UserNetwork> interpolating_user(Reactances at, double share) {
  constexpr int most_sweeps = 200;
  constexpr double settled = 1e-13;
  std::ranges::sort(at, {}, &internal::TerminationDiscs::Alias::frequency);
  struct Pole {
    double spring = 0.0;   // r
    double squared = 0.0;  // p²
  };
  std::vector<Pole> poles;
  for (const auto& each : at) {
    const double spring = share * std::abs(each.reactance) * each.frequency;
    poles.push_back({spring, each.frequency * each.frequency + spring * each.frequency / each.reactance});
  }
  double change = 1.0;
  for (int sweep = 0; sweep < most_sweeps && change > settled; ++sweep) {
    change = 0.0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double w = at[i].frequency;
      double left = at[i].reactance;
      for (std::size_t j = 0; j < poles.size(); ++j) {
        if (j != i) left -= poles[j].spring * w / (poles[j].squared - w * w);
      }
      const double squared = w * w + poles[i].spring * w / left;
      if (!(squared > 0.0) || !std::isfinite(squared)) return std::nullopt;
      change = std::max(change, std::abs(squared / poles[i].squared - 1.0));
      poles[i].squared = squared;
    }
  }
  if (!(change <= settled * 100.0)) return std::nullopt;
  UserNetwork user;
  for (const Pole& each : poles) user.absorbers.push_back({each.spring / each.squared, each.spring});
  return user;
}

// |z| - 1 of the pole farthest out, of the loop as it runs over the spring's period.
inline double excess_as_it_runs(const Device& device, double stiffness) {
  const Wall& wall = device.parameters().wall;
  const auto [period, delay] = damper_timing(device.loop());
  const internal::ScheduledLoop loop(state_space(device), {device.loop().sampling_period, device.loop().delay},
                                     {{period, delay}, wall.damping, wall.velocity_filter_hz});
  double largest = -1.0;
  for (const std::complex<double>& each : loop.poles_minus_one(stiffness)) {
    largest = std::max(largest, std::abs(1.0 + each) - 1.0);
  }
  return largest;
}

}  // namespace zwidth::test
