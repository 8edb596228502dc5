#include "identification/inverse_dynamics/rigid_band.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "identification/inverse_dynamics/motion_bandwidth.hpp"
#include "signal/fourier.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/frequency_response.hpp"

namespace zwidth::internal {
namespace {

// Of the rate: central differences of fourth order are good to 1 % there.
constexpr double most_cutoff = 0.1;

struct ExcitedBand {
  double lowest = 0.0;
  double highest = 0.5;
};

/// Between which 98 % of the signal's power without its mean lies, 1 % beyond either.
ExcitedBand excited_band(std::span<const double> force) {
  constexpr double little = 0.01;
  const auto lines = spectrum(force);
  double all = 0.0;
  for (std::size_t k = 1; k < lines.size(); ++k) all += std::norm(lines[k]);
  double sum = 0.0;
  ExcitedBand band;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const double frequency = static_cast<double>(k) / static_cast<double>(force.size());
    if (sum <= little * all) band.lowest = frequency;
    sum += std::norm(lines[k]);
    if (sum >= (1.0 - little) * all) return {band.lowest, frequency};
  }
  return band;
}

/// One line of log w^2 |P|.
struct Level {
  double frequency = 0.0;
  double level = 0.0;
  double variance = 0.0;
};

/// The middle one of each three neighbours: a line between those that the force hardly excites is no mode.
std::vector<Level> smoothed_levels(const std::vector<ResponsePoint>& points) {
  std::vector<Level> levels;
  levels.reserve(points.size());
  for (const ResponsePoint& point : points) {
    levels.push_back({point.frequency, std::log(std::abs(point.value) * point.frequency * point.frequency),
                      point.variance / std::norm(point.value)});
  }
  std::vector<Level> smoothed;
  for (std::size_t i = 1; i + 1 < levels.size(); ++i) {
    std::array<Level, 3> three{levels[i - 1], levels[i], levels[i + 1]};
    std::ranges::sort(three, {}, &Level::level);
    smoothed.push_back({levels[i].frequency, three[1].level, three[1].variance});
  }
  return smoothed;
}

/// Where the levels first turn back by 3 dB and by more than the noise at both ends explains: a peak after a rise, or a
/// dip before one. A curve that only begins to fall, or a start that rises out of friction, is none.
std::optional<double> first_turn(const std::vector<Level>& levels) {
  constexpr double least_turn = 0.35;  // nepers
  constexpr double deviations = 5.0;
  Level highest = levels.front();
  Level lowest = levels.front();
  bool has_risen = false;
  bool has_fallen = false;
  for (const Level& now : levels) {
    if (now.level > highest.level) highest = now;
    if (now.level < lowest.level) lowest = now;
    const auto differs = [&](const Level& from) {
      const double turn = std::max(least_turn, deviations * std::sqrt(from.variance + now.variance));
      return std::abs(now.level - from.level) > turn;
    };
    if (differs(lowest)) {
      if (has_fallen) return lowest.frequency;
      if (!has_risen) highest = now;
      has_risen = true;
    } else if (differs(highest)) {
      if (has_risen) return highest.frequency;
      if (!has_fallen) lowest = now;
      has_fallen = true;
    }
  }
  return std::nullopt;
}

std::optional<double> first_mode(std::span<const double> force, std::span<const double> position) {
  constexpr double least_coherence = 0.9;
  constexpr std::size_t least_lines = 20;
  FrequencyResponseOptions options;
  options.excitation = FrequencyResponseOptions::Excitation::aperiodic;
  std::vector<ResponsePoint> points;
  try {
    for (const ResponsePoint& point : frequency_response(force, position, 1.0, options).points) {
      if (point.coherence >= least_coherence && point.value != 0.0) points.push_back(point);
    }
  } catch (const Error&) {  // a record that has no response has no mode to show
    return std::nullopt;
  }
  if (points.size() < least_lines) return std::nullopt;
  std::optional<double> first = first_turn(smoothed_levels(points));
  if (first) *first /= 2.0 * std::numbers::pi;
  return first;
}

}  // namespace

RigidBand rigid_band(std::span<const double> force, std::span<const double> position) {
  // Coulomb differs from viscous friction by the harmonics that it puts on the motion's main frequency.
  constexpr double harmonics = 5.0;
  constexpr double beside_excitation = 1.5;
  constexpr double below_mode = 0.2;
  const MotionBandwidth motion = motion_bandwidth(position);
  const ExcitedBand excited = excited_band(force);
  RigidBand band;
  band.lowest = excited.lowest;
  band.highest = std::min(excited.highest, motion.nearly_all);
  band.cutoff = std::max(motion.nearly_all, harmonics * motion.half);
  band.cutoff = std::min(band.cutoff, std::max(beside_excitation * excited.highest, harmonics * motion.half));
  band.first_mode = first_mode(force, position);
  if (band.first_mode) band.cutoff = std::min(band.cutoff, below_mode * *band.first_mode);
  band.cutoff = std::min(band.cutoff, most_cutoff);
  return band;
}

}  // namespace zwidth::internal
