#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "identification/campaign/simulator.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

/// A device of the identification campaign on its bench: drawn, its limit known, the experiment to suit it.
namespace zwidth::test::campaign {

using simulated::Plant;

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  double logarithmic(double low, double high) { return low * std::pow(high / low, unit()); }
  bool chance(double share) { return unit() < share; }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }
  double normal() { return std::sqrt(-2.0 * std::log(1.0 - unit())) * std::cos(2.0 * std::numbers::pi * unit()); }
  template <typename T, std::size_t n>
  T one_of(const std::array<T, n>& values) {
    return values[below(n)];
  }

 private:
  double unit() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }
  std::mt19937_64 random_;
};

enum class Signal { multisine, random_phase, noise, linear_chirp, logarithmic_chirp, square };

/// How it was recorded.
struct Experiment {
  double period = 1e-3;
  double duration = 12.0;
  std::size_t periods = 6;  ///< of a multisine
  Signal signal = Signal::multisine;
  double lowest_hz = 0.5;
  double highest_hz = 0.0;          ///< 0: by the limit
  double force = 0.0;               ///< peak, N or N m
  std::vector<double> shares{1.0};  ///< of the peak, by recording
  double resolution = 0.0;          ///< of the encoder
  double noise = 0.3;               ///< of the position, root mean square in steps of the encoder
  double disturbance = 0.003;       ///< share of the force's root mean square
  double disturbance_pole = 0.0;    ///< per sample: 0 white
  double hum = 0.0;                 ///< the same share, at 50 Hz
  double feedback = 0.0;            ///< N/m that the recording controller adds
  double row_jitter = 0.0;          ///< share of a period by which rows are off, as their times say
  double stamp_jitter = 0.0;        ///< by which times alone are off
  double lost = 0.0;                ///< share of the rows
  double clock = 0.0;               ///< by which the position's clock is slow
  double gain = 1.0;                ///< recorded force over the one that was asked for
  std::size_t late_rows = 0;        ///< the position is of so many rows later
};

/// One device on the bench and what its owner says of it.
struct Case {
  std::string kind;
  std::uint64_t seed = 0;
  Plant plant;
  Experiment experiment;
  bool rotary = false;
  std::size_t named = 0;       ///< bodies of the structure
  bool known = false;          ///< the structure is a device file
  double stated_delay = -1.0;  ///< s, of that file; below 0: the true one
  double off = 0.0;            ///< share by which the file's free numbers are off
  std::vector<std::string> free{};
  std::vector<std::string> locked{};
  double mode_hz = 0.0;           ///< a further mode that the band goes by; 0: none
  double mode_over_band = 0.0;    ///< its place, over the end of the band
  double limit_over_band = 0.0;   ///< 0: the band holds the limit with room
  double counts_at_limit = 10.0;  ///< the least that the force moves the body there, steps of the encoder
  // What follows from these
  DeviceParameters truth;  ///< linear, as small motions are
  DeviceParameters structure;
  double stiffness = 0.0;  ///< K_CR of the truth
  double limiting_hz = 0.0;
  double mass = 0.0;     ///< of all bodies
  double damping = 0.0;  ///< of all bodies to the ground
  double stroke = 0.0;   ///< at the lowest frequency
  double speed = 0.0;    ///< there
};

namespace detail {

inline constexpr double turn = 2.0 * std::numbers::pi;

/// Coefficients by rising powers of s.
using Polynomial = std::vector<double>;
inline Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial made(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) made[i + j] += a[i] * b[j];
  }
  return made;
}
inline Polynomial sum(Polynomial a, const Polynomial& b) {
  a.resize(std::max(a.size(), b.size()), 0.0);
  for (std::size_t i = 0; i < b.size(); ++i) a[i] += b[i];
  return a;
}

/// Of one body, or two in a row, the first driven and sensed: with a joint that relaxes, and a coil with back-EMF.
inline TransferFunction transfer_function_of(const Plant& plant) {
  const auto impedance = [&](std::size_t i) {
    return Polynomial{plant.masses[i].stiffness, plant.masses[i].damping, plant.masses[i].mass};
  };
  Polynomial numerator{1.0};
  Polynomial denominator = impedance(0);
  if (plant.masses.size() > 1) {
    const simulated::Joint& joint = plant.joints[0];
    Polynomial over{1.0};
    Polynomial pull{joint.stiffness, joint.damping};
    if (joint.relaxing_stiffness > 0.0) {
      over = {joint.relaxing_stiffness, joint.relaxing_damping};
      pull = sum(product(pull, over), {0.0, joint.relaxing_stiffness * joint.relaxing_damping});
    }
    numerator = sum(product(impedance(1), over), pull);
    denominator =
        sum(product(product(impedance(0), impedance(1)), over), product(pull, sum(impedance(0), impedance(1))));
  }
  denominator = sum(product({1.0, plant.drive.lag}, denominator), product({0.0, plant.drive.back_emf}, numerator));
  for (Polynomial* each : {&numerator, &denominator}) {
    while (each->back() == 0.0) each->pop_back();
  }
  return {{numerator.rbegin(), numerator.rend()}, {denominator.rbegin(), denominator.rend()}};
}

/// The linear device of a plant, as small motions at the record's end are.
inline DeviceParameters linear_truth(const Case& c) {
  DeviceParameters device;
  device.name = "truth";
  device.motion = c.rotary ? Motion::rotary : Motion::linear;
  device.loop.sampling_period = c.experiment.period;
  device.loop.delay = c.plant.drive.delay;
  const bool relaxes = std::ranges::any_of(c.plant.joints, [](const auto& j) { return j.relaxing_stiffness > 0.0; });
  if (relaxes || c.plant.drive.back_emf > 0.0) {
    device.transfer_function = transfer_function_of(c.plant);
    return device;
  }
  device.actuator.time_constant = c.plant.drive.lag;
  const double left = 1.0 - c.plant.damping_fall * c.experiment.duration;
  for (std::size_t i = 0; i < c.plant.masses.size(); ++i) {
    const simulated::Mass& body = c.plant.masses[i];
    device.bodies.push_back({"body" + std::to_string(i), body.mass, left * body.damping, body.stiffness, 0.0});
  }
  for (const auto& joint : c.plant.joints) {
    device.links.push_back({joint.first, joint.second, joint.stiffness, joint.damping});
  }
  device.loop.actuated = c.plant.actuated;
  device.loop.sensed = c.plant.sensed;
  device.loop.held = c.named - 1;
  return device;
}

/// What its owner hands over beside the record: a named structure, or a device file whose free numbers are a little off.
inline DeviceParameters structure_of(const Case& c, Draw& draw) {
  DeviceParameters device;
  if (c.known) {
    device = c.truth;
    const auto near = [&](double& value) { value *= 1.0 + draw.uniform(-c.off, c.off); };
    const bool all = c.free.empty();
    for (Body& body : device.bodies) {
      if (!all) break;
      near(body.mass);
      near(body.damping);
      near(body.stiffness);
    }
    for (Link& link : device.links) {
      near(link.stiffness);
      near(link.damping);
    }
    if (c.stated_delay >= 0.0) device.loop.delay = c.stated_delay;
  } else {
    for (std::size_t i = 0; i < c.named; ++i) {
      device.bodies.push_back({"body" + std::to_string(i), 1.0, 1.0, 0.0, 0.0});
      if (i > 0) device.links.push_back({i - 1, i, 1.0, 1.0});
    }
    device.loop = {0, c.plant.sensed, c.named - 1, c.experiment.period, 0.0};
    device.motion = c.rotary ? Motion::rotary : Motion::linear;
  }
  device.name = "structure";
  return device;
}

/// Bodies in a row, of the sizes that haptic devices have.
inline void draw_plant(Case& c, Draw& draw, std::size_t bodies) {
  Experiment& e = c.experiment;
  e.period = draw.one_of(std::array{0.5e-3, 1e-3, 1e-3, 2e-3});
  c.rotary = draw.chance(0.25);
  const double arm = c.rotary ? draw.logarithmic(0.02, 0.1) : 1.0;  // m
  const double mass = arm * arm * draw.logarithmic(0.01, 2.0);
  const double corner = draw.logarithmic(0.5, 15.0);  // rad/s: damping to the ground over mass
  for (std::size_t i = 0; i < bodies; ++i) {
    simulated::Mass body;
    body.mass = mass * draw.logarithmic(0.4, 2.5) / static_cast<double>(bodies);
    body.damping = corner * body.mass * draw.logarithmic(0.5, 2.0);
    c.plant.masses.push_back(body);
    if (i == 0) continue;
    const double last = c.plant.masses[i - 1].mass;
    const double reduced = last * body.mass / (last + body.mass);
    const double mode = turn * draw.logarithmic(15.0, std::min(120.0, 0.15 / e.period));
    c.plant.joints.push_back({.first = i - 1,
                              .second = i,
                              .stiffness = mode * mode * reduced,
                              .damping = 2.0 * draw.logarithmic(0.005, 0.05) * mode * reduced});
  }
  if (draw.chance(0.5)) c.plant.drive.delay = draw.uniform(0.2, 1.5) * e.period;
  e.resolution = c.rotary ? turn / draw.one_of(std::array{8192.0, 20000.0, 65536.0, 131072.0})
                          : draw.one_of(std::array{0.5e-6, 1e-6, 2e-6, 5e-6, 1e-5});
  e.signal =
      draw.one_of(std::array{Signal::multisine, Signal::multisine, Signal::random_phase, Signal::logarithmic_chirp});
  e.lowest_hz = draw.one_of(std::array{0.5, 1.0});
  e.disturbance = draw.logarithmic(0.001, 0.01);
  e.noise = draw.uniform(0.1, 0.5);
  c.stroke = (c.rotary ? 1.0 / arm : 1.0) * draw.logarithmic(0.005, 0.04);
  c.named = bodies;
}

inline bool is_sweep(Signal signal) {
  return signal == Signal::linear_chirp || signal == Signal::logarithmic_chirp || signal == Signal::square;
}

/// The limit, then the band that holds it, then the force; false for a device that this experiment does not suit.
inline bool settle(Case& c, Draw& draw) {
  Experiment& e = c.experiment;
  c.truth = linear_truth(c);
  const CriticalStiffness critical = critical_stiffness(Device(c.truth));
  if (!critical.limit || !(critical.stiffness > 0.0) || !std::isfinite(critical.stiffness)) return false;
  c.stiffness = critical.stiffness;
  c.limiting_hz = critical.limit->frequency / turn;
  const double nyquist_share = 0.4 / e.period;
  const double room = draw.uniform(2.5, 5.0);
  const double over = c.limit_over_band;
  if (!(e.highest_hz > 0.0)) {
    e.highest_hz = std::max(40.0, c.limiting_hz * room);
    for (std::size_t i = 0; i + 1 < c.named; ++i) {  // and the modes of what is named
      const double first = c.plant.masses[i].mass;
      const double second = c.plant.masses[i + 1].mass;
      const double mode = std::sqrt(c.plant.joints[i].stiffness * (first + second) / (first * second)) / turn;
      e.highest_hz = std::max(e.highest_hz, 1.4 * mode);
    }
    e.highest_hz = std::min(e.highest_hz, nyquist_share);
    if (c.mode_over_band > 0.0) e.highest_hz = c.mode_hz / c.mode_over_band;
    if (over > 0.0) e.highest_hz = c.limiting_hz / over;
    if (over > 0.0 ? e.highest_hz < 8.0 : e.highest_hz < 1.3 * c.limiting_hz) return false;
    if (c.limiting_hz < 2.0 * e.lowest_hz || e.highest_hz > nyquist_share) return false;
  }
  double stiffness = 0.0;
  for (const simulated::Mass& body : c.plant.masses) {
    if (body.fixed) continue;
    c.mass += body.mass;
    c.damping += body.damping;
    stiffness += body.stiffness;
  }
  for (const auto& joint : c.plant.joints) {
    if (c.plant.masses[joint.second].fixed) stiffness += joint.stiffness;
  }
  const auto gain = [&](double hz) {
    return 1.0 / std::hypot(stiffness - c.mass * std::pow(turn * hz, 2), c.damping * turn * hz);
  };
  // Of many lines each has a small share of the peak.
  double lines = 1.0;
  if (!is_sweep(e.signal)) {
    const double tones = e.duration / static_cast<double>(e.signal == Signal::noise ? 1 : e.periods);
    lines = 1.2 * std::sqrt((e.highest_hz - e.lowest_hz) * tones) * 0.4;
  }
  const double wanted = c.stroke;
  const double inertial = 1.0 / (c.mass * std::pow(turn * std::min(c.limiting_hz, e.highest_hz), 2));
  e.force = std::max(wanted * std::max(1.0, lines) / gain(e.lowest_hz), c.counts_at_limit * e.resolution / inertial);
  c.stroke = e.force * gain(e.lowest_hz) / std::max(1.0, lines);
  c.speed = turn * e.lowest_hz * c.stroke;
  const double most = 10.0;  // times the stroke that was wanted
  return c.stroke < most * wanted;
}

}  // namespace detail

/// The limit of the truth with any passive user; NaN where it has no body to hold.
[[nodiscard]] inline double any_user_limit(const Case& c) {
  return c.truth.bodies.empty() ? std::nan("") : absolute_stability_limit(Device(c.truth)).stiffness;
}

}  // namespace zwidth::test::campaign
