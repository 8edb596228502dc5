#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "identification/campaign/bench.hpp"
#include "identification/campaign/simulator.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::test::campaign {

/// How the recordings come: as samples at equal steps, or as rows with times.
struct Rows {
  Recording recording;
  std::vector<double> times{};  ///< s; empty: equal steps
};

namespace detail {

/// The command of peak 1.
inline std::vector<double> signal_of(const Experiment& e, Draw& draw) {
  const auto count = static_cast<std::size_t>(std::lround(e.duration / e.period));
  std::vector<double> made(count, 0.0);
  if (is_sweep(e.signal)) {
    const double ratio = e.highest_hz / e.lowest_hz;
    for (std::size_t k = 0; k < count; ++k) {
      const double t = static_cast<double>(k) * e.period;
      const double turns = e.signal == Signal::linear_chirp
                               ? (e.lowest_hz + 0.5 * (e.highest_hz - e.lowest_hz) * t / e.duration) * t
                               : e.lowest_hz * e.duration * (std::pow(ratio, t / e.duration) - 1.0) / std::log(ratio);
      made[k] = std::sin(turn * turns);
      if (e.signal == Signal::square) made[k] = made[k] < 0.0 ? -1.0 : 1.0;
    }
    return made;
  }
  const std::size_t length = count / (e.signal == Signal::noise ? 1 : e.periods);
  const double spacing = 1.0 / (static_cast<double>(length) * e.period);
  const auto first = static_cast<std::size_t>(std::ceil(e.lowest_hz / spacing - 1e-9));
  const auto last = static_cast<std::size_t>(std::floor(e.highest_hz / spacing + 1e-9));
  std::vector<double> cycle(length, 0.0);
  for (std::size_t line = first; line <= last; ++line) {
    const auto i = static_cast<double>(line - first + 1);
    const double phase = e.signal == Signal::multisine
                             ? -std::numbers::pi * i * (i - 1.0) / static_cast<double>(last - first + 1)
                             : draw.uniform(0.0, turn);
    const double weight = e.signal == Signal::noise ? std::abs(draw.normal()) : 1.0;
    for (std::size_t k = 0; k < length; ++k) {
      // Whole turns are left out exactly.
      const auto part = static_cast<double>(line * k % length) / static_cast<double>(length);
      cycle[k] += weight * std::cos(turn * part + phase);
    }
  }
  double peak = 0.0;
  for (const double each : cycle) peak = std::max(peak, std::abs(each));
  for (std::size_t k = 0; k < count; ++k) made[k] = cycle[k % length] / peak;
  return made;
}

inline Rows record(const Case& c, double share, Draw& excited, Draw& noise) {
  const Experiment& e = c.experiment;
  const std::vector<double> wanted = signal_of(e, excited);
  double power = 0.0;
  for (const double each : wanted) power += each * each;
  const double rms = share * e.force * std::sqrt(power / static_cast<double>(wanted.size()));
  simulated::Motion motion(c.plant, e.period);
  std::vector<double> asked;
  std::vector<double> position;
  std::vector<double> times;
  const double offset = noise.uniform(0.0, 1.0);
  double coloured = 0.0;
  double now = 0.0;
  const auto advance_to = [&](double then) {
    if (then > now) motion.advance(then - now);
    now = std::max(now, then);
  };
  const auto sense = [&] {
    const double read = motion.position(c.plant.sensed) / e.resolution + e.noise * noise.normal() + offset;
    position.push_back(e.resolution * std::round(read));
  };
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const double even = static_cast<double>(k) * e.period;
    const double tick = even + (k > 0 ? e.period * e.row_jitter * noise.uniform(-1.0, 1.0) : 0.0);
    if (e.clock > 0.0) {  // the position's row stands for an instant of its own, later and later
      while (position.size() < wanted.size() &&
             e.period * static_cast<double>(position.size()) * (1.0 + e.clock) <= tick) {
        advance_to(e.period * static_cast<double>(position.size()) * (1.0 + e.clock));
        sense();
      }
      advance_to(tick);
    } else {
      advance_to(tick);
      sense();
    }
    const double command = share * e.force * wanted[k] - e.feedback * position.back();
    asked.push_back(e.gain * command);
    coloured =
        e.disturbance_pole * coloured + std::sqrt(1.0 - e.disturbance_pole * e.disturbance_pole) * noise.normal();
    const double hum = e.hum * std::numbers::sqrt2 * std::sin(turn * 50.0 * tick);
    motion.command(command + rms * (e.disturbance * coloured + hum));
    times.push_back(tick + (k > 0 ? e.period * e.stamp_jitter * noise.uniform(-1.0, 1.0) : 0.0));
  }
  position.erase(position.begin(), position.begin() + static_cast<std::ptrdiff_t>(e.late_rows));
  asked.resize(position.size());
  times.resize(position.size());
  Rows rows{{c.kind + " " + std::to_string(c.seed), e.period, {{"force", {}}, {"position", {}}}, {}}};
  for (std::size_t k = 0; k < position.size(); ++k) {
    if (e.lost > 0.0 && k > 0 && noise.chance(e.lost)) continue;
    rows.recording.channels[0].samples.push_back(asked[k]);
    rows.recording.channels[1].samples.push_back(position[k]);
    if (e.lost > 0.0 || e.row_jitter > 0.0 || e.stamp_jitter > 0.0) rows.times.push_back(times[k]);
  }
  return rows;
}

}  // namespace detail

/// Its recordings, each with noise of its own; the same device and force for any `noise`.
[[nodiscard]] inline std::vector<Rows> recorded(const Case& made, std::uint64_t noise = 0) {
  std::vector<Rows> rows;
  for (const double share : made.experiment.shares) {
    Draw excited(made.seed);
    Draw other(1000 * made.seed + 17 * noise + rows.size());
    rows.push_back(detail::record(made, share, excited, other));
  }
  return rows;
}

}  // namespace zwidth::test::campaign
