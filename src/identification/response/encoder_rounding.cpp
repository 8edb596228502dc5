#include "identification/response/encoder_rounding.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "identification/response/encoder_step.hpp"
#include "zwidth/identification/excitation.hpp"

namespace zwidth::internal {
namespace {

double share_of(double amplitude, double noise) {
  constexpr int harmonics = 20;
  double share = 0.0;
  for (int n = 1; n <= harmonics; ++n) {
    const double order = std::numbers::pi * n;
    const double z = 2.0 * order * amplitude;
    const double bessel_squared = std::min(0.25 * z * z, 1.0 / (std::numbers::pi * z));
    share += 2.0 * bessel_squared / std::pow(order * amplitude, 2) * std::exp(-std::pow(2.0 * order * noise, 2));
  }
  return std::min(share, 1.0);
}

/// Deviation of what dithers an encoder, in its steps: that of the quietest part of the record by its second differences,
/// less the step^2 / 12 of the rounding itself.
double dither_of(std::span<const double> position, double step) {
  constexpr std::size_t parts = 32;
  const std::size_t length = position.size() / parts;
  constexpr std::size_t shortest = 32;
  if (length < shortest) return std::numeric_limits<double>::infinity();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t part = 0; part < parts; ++part) {
    double sum = 0.0;
    for (std::size_t k = part * length + 1; k + 1 < (part + 1) * length; ++k) {
      const double bend = position[k] - 0.5 * (position[k - 1] + position[k + 1]);
      sum += bend * bend;
    }
    least = std::min(least, sum / static_cast<double>(length - 2));
  }
  constexpr double of_white = 1.5;  // 1 + 2 / 4
  return std::sqrt(std::max(0.0, least / (of_white * step * step) - 1.0 / 12.0));
}

/// The amplitude of a force that is one sine at any time; 0 of any other.
double sweep_amplitude(std::span<const double> force) {
  const CrestFactor crest = crest_factor(force);
  constexpr double smallest = 1.3;  // a sine's is sqrt(2)
  constexpr double largest = 1.6;
  if (!(crest.peak > smallest * crest.rms && crest.peak < largest * crest.rms)) return 0.0;
  return std::numbers::sqrt2 * crest.rms;
}

}  // namespace

SweepRounding::SweepRounding(std::span<const double> force, std::span<const double> position)
    : force_(sweep_amplitude(force)), step_(encoder_step(position)) {
  if (force_ > 0.0 && step_ > 0.0) noise_ = dither_of(position, step_);
}

double SweepRounding::variance(std::complex<double> value) const {
  if (force_ == 0.0 || step_ == 0.0 || value == 0.0) return 0.0;
  return std::norm(value) * share_of(force_ * std::abs(value) / step_, noise_);
}

double largest_rounding(std::span<const double> position) {
  constexpr double dithers = 0.4;
  const double step = encoder_step(position);
  return step > 0.0 && dither_of(position, step) < dithers ? 0.5 * step : 0.0;
}

}  // namespace zwidth::internal
