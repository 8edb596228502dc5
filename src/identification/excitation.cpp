#include "zwidth/identification/excitation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identification/excitation_spectrum.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
using namespace internal;
namespace {

void require(bool met, std::string_view what, double value, std::string_view allowed) {
  if (!met) throw Error(ErrorCode::invalid_argument, fmt::format("{} is {:.9g}; {}", what, value, allowed));
}

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

/// Whole samples, and remarks where the duration is rounded. Throws for options that make no signal.
std::size_t checked_size(const ExcitationOptions& options) {
  require(positive(options.amplitude), "amplitude", options.amplitude, "a force > 0");
  require(positive(options.rate), "rate", options.rate, "a frequency in Hz > 0");
  require(positive(options.duration), "duration", options.duration, "a time in s > 0");
  const double size = std::round(options.duration * options.rate);
  require(size >= 2.0 && size <= max_excitation_samples, "duration times rate", options.duration * options.rate,
          fmt::format("2 to {:g} samples", max_excitation_samples));
  const double nyquist = 0.5 * options.rate;
  require(positive(options.lowest_hz) && options.lowest_hz <= nyquist, "lowest frequency", options.lowest_hz,
          fmt::format("above 0 and at most half the rate, {:g} Hz", nyquist));
  if (options.kind != ExcitationKind::relay) {
    require(options.highest_hz >= options.lowest_hz && options.highest_hz <= nyquist, "highest frequency",
            options.highest_hz,
            fmt::format("from the lowest, {:g} Hz, to half the rate, {:g} Hz", options.lowest_hz, nyquist));
  }
  const int fades = options.kind == ExcitationKind::multisine ? 1 : 2;
  require(options.fade_in >= 0.0 && fades * options.fade_in <= options.duration, "fade-in", options.fade_in,
          fades == 1 ? "0 to the duration" : "0 to half the duration: the end fades as the start does");
  return static_cast<std::size_t>(size);
}

void remark_rounding(Excitation& excitation, std::string_view what, double wanted, double actual,
                     std::string_view unit) {
  if (std::abs(actual - wanted) <= 1e-9 * wanted) return;
  excitation.remarks.push_back({Remark::Severity::note,
                                fmt::format("{} is {:.9g} {} instead of {:.9g}", what, actual, unit, wanted),
                                "rounded to whole samples"});
}

/// A sine whose phase, in turns, is given as a function of time.
template <typename Turns>
void add_sweep(Excitation& excitation, const ExcitationOptions& options, std::size_t size, Turns&& turns) {
  excitation.samples.resize(size);
  for (std::size_t k = 0; k < size; ++k) {
    const double phase = turns(static_cast<double>(k) / options.rate);
    excitation.samples[k] = options.amplitude * std::sin(2.0 * std::numbers::pi * (phase - std::floor(phase)));
  }
}

void add_chirp(Excitation& excitation, const ExcitationOptions& options, std::size_t size) {
  const double duration = static_cast<double>(size) / options.rate;
  const double lowest = options.lowest_hz;
  if (options.kind == ExcitationKind::linear_chirp) {
    const double slope = 0.5 * (options.highest_hz - lowest) / duration;
    add_sweep(excitation, options, size, [&](double t) { return (lowest + slope * t) * t; });
  } else {
    const double growth = std::log(options.highest_hz / lowest) / duration;  // 1/s
    add_sweep(excitation, options, size,
              [&](double t) { return lowest * (growth == 0.0 ? t : std::expm1(growth * t) / growth); });
  }
}

void add_multisine(Excitation& excitation, const ExcitationOptions& options, std::size_t size) {
  require(options.periods >= 1 && 2 * options.periods <= size, "number of periods",
          static_cast<double>(options.periods), "at least 1, and each of at least two samples");
  const double samples_each = static_cast<double>(size) / static_cast<double>(options.periods);
  excitation.period = static_cast<std::size_t>(std::round(samples_each));
  const std::vector<double> period =
      schroeder_multisine(excitation.period, {options.lowest_hz / options.rate, options.highest_hz / options.rate});
  excitation.samples.reserve(excitation.period * options.periods);
  for (std::size_t i = 0; i < options.periods; ++i) {
    excitation.samples.insert(excitation.samples.end(), period.begin(), period.end());
  }
}

void add_relay(Excitation& excitation, const ExcitationOptions& options, std::size_t size) {
  const auto half = static_cast<std::size_t>(std::round(0.5 * options.rate / options.lowest_hz));
  excitation.samples.resize(size);
  for (std::size_t k = 0; k < size; ++k) {
    excitation.samples[k] = k / half % 2 == 0 ? options.amplitude : -options.amplitude;
  }
  excitation.period = 2 * half;
  remark_rounding(excitation, "the relay's frequency", options.lowest_hz,
                  options.rate / static_cast<double>(excitation.period), "Hz");
}

void scale_to_peak(std::vector<double>& samples, double amplitude) {
  const double peak = crest_factor(samples).peak;
  for (double& sample : samples) sample *= amplitude / peak;
}

void fade(std::vector<double>& samples, const ExcitationOptions& options) {
  if (options.fade_in == 0.0) return;
  const double length = options.fade_in * options.rate;
  const auto faded = std::min(samples.size(), static_cast<std::size_t>(std::ceil(length)));
  for (std::size_t k = 0; k < faded; ++k) {
    const double factor = 0.5 * (1.0 - std::cos(std::numbers::pi * static_cast<double>(k) / length));
    samples[k] *= factor;
    if (options.kind != ExcitationKind::multisine) samples[samples.size() - 1 - k] *= factor;
  }
}

}  // namespace

Excitation excite(const ExcitationOptions& options) {
  const std::size_t size = checked_size(options);
  Excitation excitation;
  switch (options.kind) {
    case ExcitationKind::linear_chirp:
    case ExcitationKind::logarithmic_chirp:
      add_chirp(excitation, options, size);
      break;
    case ExcitationKind::multisine:
      add_multisine(excitation, options, size);
      scale_to_peak(excitation.samples, options.amplitude);
      break;
    case ExcitationKind::noise:
      excitation.samples =
          band_limited_noise(size, {options.lowest_hz / options.rate, options.highest_hz / options.rate}, options.seed);
      scale_to_peak(excitation.samples, options.amplitude);
      break;
    case ExcitationKind::relay:
      add_relay(excitation, options, size);
      break;
  }
  fade(excitation.samples, options);
  const double duration = static_cast<double>(excitation.samples.size()) / options.rate;
  remark_rounding(excitation, "the duration", options.duration, duration, "s");
  if (duration * options.lowest_hz < 1.0) {
    excitation.remarks.push_back(
        {Remark::Severity::warning,
         fmt::format("{:g} s hold less than one cycle of {:g} Hz", duration, options.lowest_hz),
         "nothing can be told about that frequency; make the duration longer"});
  }
  return excitation;
}

CrestFactor crest_factor(std::span<const double> signal) {
  CrestFactor crest;
  double sum = 0.0;
  for (const double sample : signal) {
    crest.peak = std::max(crest.peak, std::abs(sample));
    sum += sample * sample;
  }
  if (crest.peak > 0.0) {
    crest.rms = std::sqrt(sum / static_cast<double>(signal.size()));
    crest.factor = crest.peak / crest.rms;
  }
  return crest;
}

}  // namespace zwidth
