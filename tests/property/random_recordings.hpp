#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "zwidth/identification/excitation.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/signal/recording.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::test {

/// A simulated experiment whose truth is known.
struct RandomRecording {
  std::uint64_t seed = 0;
  Recording recording;         ///< force, position
  DeviceParameters truth;      ///< with its friction
  DeviceParameters structure;  ///< what the user names: placeholders for every number
  double stiffness = 0.0;      ///< K_CR of the truth without friction
  double limiting_hz = 0.0;
  double lowest_hz = 0.0;  ///< of the excited band
  double highest_hz = 0.0;
  bool right_structure = true;
  bool has_friction = false;
  std::string what;
};

struct RecordingFamily {
  double friction_share = 0.25;
  double wrong_structure_share = 0.15;
  std::size_t bodies = 0;  ///< of the device, at most 5; 0: 1 to 3
  std::size_t named = 0;   ///< of the structure; 0: as many, or one too few
};

namespace detail {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  double logarithmic(double low, double high) { return low * std::pow(high / low, unit()); }
  bool chance(double share) { return unit() < share; }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }
  double normal() { return std::sqrt(-2.0 * std::log(1.0 - unit())) * std::cos(2.0 * std::numbers::pi * unit()); }

 private:
  double unit() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }
  std::mt19937_64 random_;
};

/// A chain of bodies from the motor to the handle.
inline DeviceParameters random_chain(Draw& draw, std::size_t bodies) {
  static const std::array names{"motor", "body", "second", "third", "handle"};
  DeviceParameters device;
  device.name = "random";
  device.loop.sampling_period = std::array{0.5e-3, 1e-3, 2e-3}[draw.below(3)];
  const double mass = draw.logarithmic(0.05, 5.0);
  const double corner = draw.logarithmic(0.3, 20.0);  // rad/s: damping to ground over mass
  for (std::size_t i = 0; i < bodies; ++i) {
    Body body;
    body.name = bodies == 1 ? "body" : i + 1 == bodies ? "handle" : names[i];
    body.mass = mass * draw.logarithmic(0.3, 3.0) / static_cast<double>(bodies);
    body.damping = corner * body.mass * draw.logarithmic(0.5, 2.0);
    device.bodies.push_back(body);
    if (i == 0) continue;
    const Body& last = device.bodies[i - 1];
    const double reduced = last.mass * body.mass / (last.mass + body.mass);
    const double mode = 2.0 * std::numbers::pi * draw.logarithmic(15.0, 0.25 / device.loop.sampling_period);
    const double stiffness = mode * mode * reduced;
    device.links.push_back({i - 1, i, stiffness, 2.0 * draw.logarithmic(0.005, 0.1) * mode * reduced});
  }
  device.loop.held = bodies - 1;
  if (draw.chance(0.6)) device.loop.delay = draw.uniform(0.0, 3.0) * device.loop.sampling_period;
  if (draw.chance(0.3)) device.actuator.time_constant = draw.uniform(0.1, 1.5) * device.loop.sampling_period;
  return device;
}

/// The chain under held forces with dry friction: semi-implicit steps, friction as an impulse that may stop a body but
/// not turn it (Moreau 1988).
inline std::vector<double> motion_with_friction(const DeviceParameters& device, const std::vector<double>& force) {
  constexpr int parts = 40;  // per sampling period
  const double step = device.loop.sampling_period / parts;
  const std::size_t n = device.bodies.size();
  std::vector<double> x(n, 0.0);
  std::vector<double> v(n, 0.0);
  std::vector<double> f(n, 0.0);
  std::vector<double> position;
  const auto late = static_cast<long>(std::round(device.loop.delay / step));
  const double lag = device.actuator.time_constant;
  double real = 0.0;
  long now = 0;
  for (std::size_t k = 0; k < force.size(); ++k) {
    position.push_back(x[device.loop.sensed]);
    for (int part = 0; part < parts; ++part, ++now) {
      const long arrived = now - late;
      const double command = arrived < 0 ? 0.0 : force[static_cast<std::size_t>(arrived / parts)];
      real = lag > 0.0 ? command + (real - command) * std::exp(-step / lag) : command;
      for (std::size_t i = 0; i < n; ++i) f[i] = -device.bodies[i].damping * v[i] - device.bodies[i].stiffness * x[i];
      f[device.loop.actuated] += real;
      for (const Link& link : device.links) {
        const double pull =
            link.stiffness * (x[link.first] - x[link.second]) + link.damping * (v[link.first] - v[link.second]);
        f[link.first] -= pull;
        f[link.second] += pull;
      }
      for (std::size_t i = 0; i < n; ++i) {
        const double free = v[i] + step * f[i] / device.bodies[i].mass;
        const double stop = step * device.bodies[i].coulomb / device.bodies[i].mass;
        v[i] = std::abs(free) <= stop ? 0.0 : free - std::copysign(stop, free);
        x[i] += step * v[i];
      }
    }
  }
  return position;
}

}  // namespace detail

/// The recording of this seed; nothing for a device that no wall is stable with, or that none limits.
inline std::optional<RandomRecording> random_recording(std::uint64_t seed, const RecordingFamily& family = {}) {
  detail::Draw draw(seed);
  RandomRecording made;
  made.seed = seed;
  const std::size_t drawn = std::array<std::size_t, 6>{1, 1, 2, 2, 2, 3}[draw.below(6)];
  const std::size_t bodies = family.bodies > 0 ? family.bodies : drawn;
  DeviceParameters truth = detail::random_chain(draw, bodies);
  const bool handle_sensed = bodies == 2 && draw.chance(0.3);
  if (handle_sensed) truth.loop.sensed = 1;
  const double period = truth.loop.sampling_period;

  const CriticalStiffness critical = critical_stiffness(Device(truth));
  if (!critical.limit || !(critical.stiffness > 0.0)) return std::nullopt;
  made.stiffness = critical.stiffness;
  made.limiting_hz = critical.limit->frequency / (2.0 * std::numbers::pi);

  ExcitationOptions excitation;
  excitation.kind = std::array{ExcitationKind::multisine, ExcitationKind::noise, ExcitationKind::linear_chirp,
                               ExcitationKind::logarithmic_chirp}[draw.below(4)];
  excitation.amplitude = draw.logarithmic(1.0, 20.0);
  excitation.duration = draw.uniform(10.0, 25.0);
  excitation.rate = 1.0 / period;
  excitation.lowest_hz = draw.logarithmic(0.3, 3.0);
  excitation.highest_hz = draw.logarithmic(5.0, 0.45 / period);
  excitation.periods = 5 + draw.below(6);
  excitation.seed = seed;
  if (excitation.kind == ExcitationKind::multisine) {
    const double samples = std::floor(excitation.duration / (period * static_cast<double>(excitation.periods)));
    excitation.duration = samples * period * static_cast<double>(excitation.periods);
  }
  const Excitation signal = excite(excitation);
  made.lowest_hz = excitation.lowest_hz;
  made.highest_hz = excitation.highest_hz;

  std::vector<double> real = signal.samples;
  const double disturbance = draw.logarithmic(0.0005, 0.02) * crest_factor(signal.samples).rms;
  for (double& value : real) value += disturbance * draw.normal();
  made.has_friction = draw.chance(family.friction_share);
  if (made.has_friction) {
    truth.bodies[draw.below(bodies)].coulomb = draw.logarithmic(0.01, 0.2) * crest_factor(signal.samples).rms;
  }
  std::vector<double> position =
      made.has_friction ? detail::motion_with_friction(truth, real)
                        : forced_response(sample(state_space(Device(truth)), {period, truth.loop.delay}), real);
  if (!std::isfinite(position.back())) return std::nullopt;  // steps of friction too coarse for its stiffest mode
  double moved = 0.0;
  for (std::size_t k = 1; k < position.size(); ++k) moved += std::pow(position[k] - position[k - 1], 2);
  moved = std::sqrt(moved / static_cast<double>(position.size()));
  const double resolution = moved * draw.logarithmic(0.002, 0.3);
  const double noise = draw.chance(0.5) ? moved * draw.logarithmic(0.002, 0.1) : 0.0;
  const double offset = draw.uniform(0.0, resolution);
  for (double& value : position) value = resolution * std::round((value + noise * draw.normal() + offset) / resolution);

  made.truth = truth;
  made.right_structure =
      family.named > 0 ? family.named == bodies : bodies == 1 || !draw.chance(family.wrong_structure_share);
  DeviceParameters structure;
  structure.name = "structure";
  const std::size_t named = family.named > 0 ? family.named : made.right_structure ? bodies : bodies - 1;
  for (std::size_t i = 0; i < named; ++i) {
    structure.bodies.push_back({"body" + std::to_string(i), 1.0, 1.0, 0.0, 0.0});
    if (i > 0) structure.links.push_back({i - 1, i, 1.0, 1.0});
  }
  structure.loop = {0, handle_sensed ? named - 1 : 0, named - 1, period, 0.0};
  made.structure = structure;
  made.recording = {"seed " + std::to_string(seed), period, {{"force", signal.samples}, {"position", position}}, {}};
  static const std::array kinds{"linear_chirp", "logarithmic_chirp", "multisine", "noise", "relay"};
  made.what = std::to_string(bodies) + " bodies" + (handle_sensed ? ", handle sensed" : "") +
              (made.right_structure ? "" : ", one too few named") + (made.has_friction ? ", friction" : "") + ", " +
              kinds[static_cast<std::size_t>(excitation.kind)];
  return made;
}

}  // namespace zwidth::test
