#include "identification/rigid_band.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "identification/motion_bandwidth.hpp"
#include "identification/response_features.hpp"
#include "signal/fourier.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/frequency_response.hpp"

namespace zwidth::internal {
namespace {

// Of the rate: central differences of fourth order are good to 1 % there.
constexpr double most_cutoff = 0.1;

/// Below which 99 % of the signal's power without its mean lies.
double excited_up_to(std::span<const double> force) {
  constexpr double nearly_all = 0.99;
  const auto lines = spectrum(force);
  double all = 0.0;
  for (std::size_t k = 1; k < lines.size(); ++k) all += std::norm(lines[k]);
  double sum = 0.0;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    sum += std::norm(lines[k]);
    if (sum >= nearly_all * all) return static_cast<double>(k) / static_cast<double>(force.size());
  }
  return 0.5;
}

/// Where the inertance first turns back, among lines that force and motion share.
std::optional<double> first_mode(std::span<const double> force, std::span<const double> position) {
  constexpr double least_coherence = 0.7;
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
  const ResponseFeatures features = response_features(points);
  std::optional<double> first;
  for (const std::vector<double>* extremes : {&features.resonances, &features.antiresonances}) {
    if (!extremes->empty() && (!first || extremes->front() < *first)) first = extremes->front();
  }
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
  RigidBand band;
  band.cutoff = std::max(motion.nearly_all, harmonics * motion.half);
  band.cutoff = std::min(band.cutoff, std::max(beside_excitation * excited_up_to(force), harmonics * motion.half));
  band.first_mode = first_mode(force, position);
  if (band.first_mode) band.cutoff = std::min(band.cutoff, below_mode * *band.first_mode);
  band.cutoff = std::min(band.cutoff, most_cutoff);
  return band;
}

}  // namespace zwidth::internal
