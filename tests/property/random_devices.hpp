#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string_view>

#include "zwidth/model/device.hpp"

namespace zwidth::test {

// The fifteen kinds of the reference data, and six harder ones.
inline constexpr std::size_t reference_kinds = 15;
inline constexpr std::array<std::string_view, 21> device_kinds = {
    "rigid",         "two_mass",        "user_side",        "three_mass",
    "light_damping", "long_delay",      "fractional_delay", "slow_sampling",
    "fast_sampling", "virtual_damper",  "operator",         "grounded",
    "rotary",        "filtered_damper", "actuator_lag",     "overdamped",
    "chain",         "stiff_link",      "everything",       "transfer_function",
    "wall_filter"};

// Devices whose poles crowd, or whose response is far below its terms: double-double does not carry their terms.
// Eigenvalues in double know as little of them, so they have a test of their own.
inline constexpr std::array<std::string_view, 8> crowded_kinds = {
    "equal_lags",  "close_real_poles", "many_real_poles", "equal_pairs",
    "close_pairs", "two_clusters",     "alike_bodies",    "far_end_of_a_chain"};

class RandomDevices {
 public:
  explicit RandomDevices(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  std::size_t index(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_); }

  DeviceParameters device(std::string_view kind) {
    DeviceParameters d;
    d.name = kind;
    d.loop.sampling_period = 1e-3;
    const bool everything = kind == "everything";
    if (kind == "rigid") {
      d.bodies.push_back(body("handle", 0.03, 10.0));
      if (chance(0.5)) d.loop.delay = log_uniform(1e-5, 3e-4);
      return d;
    }
    if (kind == "transfer_function") {
      d.transfer_function = transfer_function();
      d.loop.sampling_period = log_uniform(1e-3, 0.3);
      if (chance(0.5)) d.loop.delay = log_uniform(0.01, 5.0) * d.loop.sampling_period;
      if (chance(0.3)) d.wall.damping = log_uniform(1e-3, 1.0);
      return d;
    }
    d.bodies.push_back(body("motor", 0.01, 1.0));
    std::size_t middle = kind == "three_mass" ? 1 : 0;
    if (kind == "chain" || everything) middle = index(3);
    for (std::size_t i = 0; i < middle; ++i) d.bodies.push_back(body("carriage" + std::to_string(i), 0.1, 2.0));
    d.bodies.push_back(body("handle", 0.04, 10.0));
    d.loop.held = d.bodies.size() - 1;

    double lowest = 15.0;
    double highest = 450.0;
    double least_ratio = 1e-3;
    double greatest_ratio = 0.2;
    if (kind == "light_damping") least_ratio = 1e-5, greatest_ratio = 1e-3;
    if (kind == "overdamped") least_ratio = 0.5, greatest_ratio = 5.0;
    if (kind == "stiff_link") lowest = 3e3, highest = 3e5;
    if (kind == "slow_sampling" || everything) {
      d.loop.sampling_period = std::array{1e-3, 2e-3, 5e-3, 1e-2}[index(4)];
      lowest = kind == "slow_sampling" ? 300.0 : 15.0;
      highest = 3000.0;
    }
    // Not with long chains: across several links and far above their modes the response falls below 1e-18 of its terms,
    // where crossovers (at K of 1e18 N/m and more) are rounding.
    if (kind == "fast_sampling" || (everything && d.bodies.size() == 2 && chance(0.5))) {
      d.loop.sampling_period = std::array{1e-5, 2.5e-5, 5e-5, 1e-4}[index(4)];
    }
    for (std::size_t i = 0; i + 1 < d.bodies.size(); ++i) {
      const double m1 = d.bodies[i].mass;
      const double m2 = d.bodies[i + 1].mass;
      const double reduced = m1 * m2 / (m1 + m2);
      const double w = 2.0 * std::numbers::pi * log_uniform(lowest, highest);
      d.links.push_back({i, i + 1, reduced * w * w, 2.0 * log_uniform(least_ratio, greatest_ratio) * w * reduced});
    }
    const double period = d.loop.sampling_period;
    if (kind == "user_side") d.loop.sensed = 1;
    if (kind == "three_mass" || kind == "chain" || everything) d.loop.sensed = index(d.bodies.size());
    if (kind == "user_side" || kind == "three_mass" || kind == "fast_sampling" || kind == "virtual_damper" ||
        kind == "filtered_damper" || kind == "operator" || kind == "actuator_lag") {
      if (chance(0.5)) d.loop.delay = log_uniform(1e-2, 2.0) * period;
    }
    if (kind == "fractional_delay") d.loop.delay = log_uniform(1e-3, 2.0) * period;
    if (kind == "long_delay")
      d.loop.delay = chance(0.5) ? static_cast<double>(3 + index(10)) * period : uniform(3.0, 15.0) * period;
    if (everything && chance(0.7)) d.loop.delay = log_uniform(1e-2, 10.0) * period;
    if (kind == "virtual_damper" || kind == "filtered_damper" || (everything && chance(0.5))) {
      d.wall.damping = log_uniform(0.05, 50.0);
      if (kind == "filtered_damper" || (everything && chance(0.5)))
        d.wall.velocity_filter_hz = log_uniform(20.0, 400.0);
    }
    if (kind == "operator" || (everything && chance(0.5))) {
      d.user = {log_uniform(0.05, 0.8), log_uniform(1.0, 30.0), log_uniform(20.0, 1000.0)};
    }
    if (kind == "grounded" || (everything && chance(0.3))) {
      d.bodies[index(d.bodies.size())].stiffness = log_uniform(1.0, 2000.0);
    }
    if (kind == "actuator_lag" || (everything && chance(0.3))) d.actuator.time_constant = log_uniform(5e-5, 3e-3);
    if (kind == "wall_filter") {
      if (chance(0.5)) d.loop.delay = log_uniform(1e-2, 3.0) * period;
      if (chance(0.4)) d.wall.damping = log_uniform(0.05, 50.0);
      const std::size_t filters = 1 + index(2);
      for (std::size_t i = 0; i < filters; ++i) d.wall.filters.push_back(wall_filter(period));
    }
    if (kind == "rotary") {
      d.motion = Motion::rotary;
      for (Body& b : d.bodies) b.mass *= 1e-4, b.damping *= 1e-4;
      for (Link& link : d.links) link.stiffness *= 1e-4, link.damping *= 1e-4;
    }
    return d;
  }

  DeviceParameters crowded_device(std::string_view kind) {
    DeviceParameters d;
    d.name = kind;
    d.loop.sampling_period = 1e-3;
    TransferFunction g{{1.0}, {1.0}};
    const double w = log_uniform(0.5, 500.0);
    const auto real_poles = [&](std::size_t count, double spread, double around) {
      for (std::size_t i = 0; i < count; ++i) {
        g.denominator = times(g.denominator, {1.0, around * (1.0 + spread * uniform(-1.0, 1.0))});
      }
    };
    if (kind == "equal_lags") real_poles(4 + index(9), 0.0, w);
    if (kind == "close_real_poles") real_poles(8 + index(3), log_uniform(1e-3, 0.1), w);
    if (kind == "many_real_poles") real_poles(12 + index(9), 0.5, w);
    if (kind == "equal_pairs" || kind == "close_pairs") {
      const double ratio = log_uniform(0.01, 0.9);
      const double spread = kind == "equal_pairs" ? 0.0 : log_uniform(1e-6, 0.1);
      const std::size_t pairs = 2 + index(5);
      for (std::size_t i = 0; i < pairs; ++i) {
        const double own = w * (1.0 + spread * uniform(-1.0, 1.0));
        g.denominator = times(g.denominator, {1.0, 2.0 * ratio * own, own * own});
      }
    }
    if (kind == "two_clusters") {
      real_poles(3 + index(4), 0.02, w);
      real_poles(3 + index(4), 0.02, w * log_uniform(2.0, 100.0));
      if (chance(0.5)) g.numerator = {0.5 / w, 1.0};
    }
    if (g.denominator.size() > 1) {
      for (double& c : g.numerator) c *= g.denominator.back();
      d.transfer_function = g;
    }
    if (kind == "alike_bodies") {  // each on its own spring, barely tied to the next
      const Body first{"", log_uniform(0.05, 1.0), log_uniform(0.05, 5.0), log_uniform(100.0, 5000.0), 0.0};
      const double spread = log_uniform(1e-8, 1e-2);
      for (std::size_t i = 0; i < 4; ++i) {
        d.bodies.push_back(first);
        d.bodies.back().name = "body" + std::to_string(i);
        d.bodies.back().mass *= 1.0 + spread * uniform(-1.0, 1.0);
        d.bodies.back().stiffness *= 1.0 + spread * uniform(-1.0, 1.0);
      }
      const double tie = first.stiffness * log_uniform(1e-6, 0.1);
      for (std::size_t i = 0; i < 3; ++i) d.links.push_back({i, i + 1, tie, 0.0});
      d.loop.sensed = index(4);
      d.loop.held = 3;
    }
    if (kind == "far_end_of_a_chain") {
      const std::size_t bodies = 6 + index(7);
      const Body each{"", log_uniform(0.03, 0.3), log_uniform(0.01, 1.0), 0.0, 0.0};
      const double stiffness = log_uniform(1e3, 1e5);
      const double damping = log_uniform(0.1, 5.0);
      for (std::size_t i = 0; i < bodies; ++i) {
        d.bodies.push_back(each);
        d.bodies.back().name = "body" + std::to_string(i);
        if (i > 0) d.links.push_back({i - 1, i, stiffness, damping});
      }
      d.loop.sensed = d.loop.held = bodies - 1;
    }
    if (chance(0.3)) d.loop.delay = log_uniform(0.05, 3.0) * d.loop.sampling_period;
    if (chance(0.2)) d.actuator.time_constant = log_uniform(1e-4, 1e-2);
    return d;
  }

 private:
  static std::vector<double> times(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> product(a.size() + b.size() - 1, 0.0);
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
    return product;
  }

  WallFilter wall_filter(double period) {
    WallFilter filter;
    filter.kind = std::array{WallFilter::Kind::low_pass, WallFilter::Kind::notch, WallFilter::Kind::lead_lag,
                             WallFilter::Kind::digital}[index(4)];
    if (filter.kind == WallFilter::Kind::digital) {  // poles and zeros at radius r and angle t; or an average of two
      filter.numerator = {0.5, 0.5};
      filter.denominator = {1.0, 0.0};
      if (chance(0.3)) return filter;
      const double r = uniform(0.1, 0.98);
      const double t = uniform(0.0, std::numbers::pi);
      filter.denominator = {1.0, -2.0 * r * std::cos(t), r * r};
      filter.numerator = {1.0, -uniform(-1.9, 1.9), 0.95};
      return filter;
    }
    filter.frequency_hz = log_uniform(5.0, 0.48 / period);
    filter.order = 1 + static_cast<int>(index(2));
    filter.damping_ratio = log_uniform(0.02, 2.0);
    filter.depth = log_uniform(1e-3, 1.0);
    filter.ratio = log_uniform(0.1, 10.0);
    return filter;
  }

  // Poles and zeros anywhere: in the right half plane, at the origin, twice the same; either sign of the gain.
  TransferFunction transfer_function() {
    const auto factor = [this]() -> std::vector<double> {
      if (chance(0.1)) return {1.0, 0.0};
      const double sign = chance(0.15) ? -1.0 : 1.0;
      if (chance(0.5)) return {1.0, sign * log_uniform(0.1, 10.0)};
      const double w = log_uniform(0.3, 30.0);
      return {1.0, sign * 2.0 * log_uniform(1e-3, 1.0) * w, w * w};
    };
    TransferFunction result{{chance(0.8) ? 1.0 : -1.0}, {1.0}};
    const std::size_t factors = 1 + index(3);
    for (std::size_t i = 0; i < factors; ++i) {
      const std::vector<double> drawn = factor();
      result.denominator = times(result.denominator, drawn);
      if (chance(0.15)) result.denominator = times(result.denominator, drawn);
    }
    while (chance(0.4)) {
      const std::vector<double> numerator = times(result.numerator, factor());
      if (numerator.size() >= result.denominator.size()) break;
      result.numerator = numerator;
    }
    return result;
  }

  Body body(std::string name, double lightest, double heaviest) {
    return {std::move(name), log_uniform(lightest, heaviest), log_uniform(0.01, 10.0), 0.0, 0.0};
  }

  std::mt19937_64 engine_;
};

}  // namespace zwidth::test
