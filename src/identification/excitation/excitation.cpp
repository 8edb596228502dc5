#include "zwidth/identification/excitation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identification/excitation/excitation_check.hpp"
#include "identification/excitation/excitation_spectrum.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_key.hpp"

namespace zwidth {
using namespace internal;
namespace {

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

/// In samples of the whole signal; of a multisine, of one period.
std::size_t size_of(const ExcitationOptions& options, double rate) {
  return static_cast<std::size_t>(std::round(options.duration * rate));
}
std::size_t period_of(const ExcitationOptions& options, std::size_t size) {
  return static_cast<std::size_t>(std::round(static_cast<double>(size) / static_cast<double>(options.periods)));
}
RelativeBand band_of(const ExcitationOptions& options, double rate) {
  return {options.lowest_hz / rate, options.highest_hz / rate};
}

std::optional<OptionProblem> find_problem(const ExcitationOptions& options, double rate) {
  std::optional<OptionProblem> found;
  const auto require = [&](bool met, const char* member, double value, const std::string& allowed) {
    if (!met && !found) found = OptionProblem{member, fmt::format("is {:.9g}", value), allowed};
  };
  require(positive(options.amplitude), "amplitude", options.amplitude, "a force > 0");
  if (!found && !positive_numbers.contains(options.amplitude)) {
    found = option_problem("amplitude", {.code = ProblemCode::not_between,
                                         .evidence = {{"value", options.amplitude},
                                                      {"least", positive_numbers.least},
                                                      {"most", positive_numbers.greatest}}});
  }
  require(positive(rate), "rate", rate, "a frequency in Hz > 0");
  require(positive(options.duration), "duration", options.duration, "a time in s > 0");
  const double size = std::round(options.duration * rate);
  if (!found && !(size >= 2.0 && size <= max_excitation_samples)) {
    // Of the two that make the samples, the one that does so by itself.
    const bool is_the_rate = options.rate && options.duration * default_excitation_rate <= max_excitation_samples &&
                             size > max_excitation_samples;
    found =
        OptionProblem{is_the_rate ? "rate" : "duration",
                      fmt::format("times the {} is {:.9g}", is_the_rate ? "duration" : "rate", options.duration * rate),
                      fmt::format("2 to {:g} samples", max_excitation_samples)};
  }
  const double nyquist = 0.5 * rate;
  require(positive(options.lowest_hz) && options.lowest_hz <= nyquist, "lowest_hz", options.lowest_hz,
          fmt::format("above 0 and at most half the rate, {:g} Hz", nyquist));
  require(options.kind == ExcitationKind::relay ||
              (options.highest_hz >= options.lowest_hz && options.highest_hz <= nyquist),
          "highest_hz", options.highest_hz,
          fmt::format("from the lowest, {:g} Hz, to half the rate, {:g} Hz", options.lowest_hz, nyquist));
  const bool fades_once = options.kind == ExcitationKind::multisine;
  require(options.fade_in >= 0.0 && (fades_once ? 1.0 : 2.0) * options.fade_in <= options.duration, "fade_in",
          options.fade_in,
          fades_once ? "0 to the duration" : "0 to half the duration: the end fades as the start does");
  require(!options.stroke_limit || positive(*options.stroke_limit), "stroke_limit", options.stroke_limit.value_or(0.0),
          "a length in m (rotary: rad) above 0");
  if (found) return found;
  if (options.kind == ExcitationKind::multisine) {
    const std::size_t samples = size_of(options, rate);
    require(options.periods >= 1 && 2 * options.periods <= samples, "periods", static_cast<double>(options.periods),
            "at least 1, and each of at least two samples");
    return found ? found : internal::find_problem(period_of(options, samples), band_of(options, rate));
  }
  if (options.kind == ExcitationKind::noise) {
    return internal::find_problem(size_of(options, rate), band_of(options, rate));
  }
  return found;
}

void remark_rounding(Excitation& excitation, std::string_view what, double wanted, double actual,
                     std::string_view unit) {
  if (std::abs(actual - wanted) <= 1e-9 * wanted) return;
  excitation.remarks.push_back(note({.code = FindingCode::excitation_rounded,
                                     .evidence = {{"actual", actual}, {"wanted", wanted}},
                                     .subjects = {{"what", std::string(what)}, {"unit", std::string(unit)}}}));
}

/// A sine whose phase, in turns, is given as a function of time.
template <typename Turns>
void add_sweep(Excitation& excitation, std::size_t size, Turns&& turns) {
  excitation.samples.resize(size);
  for (std::size_t k = 0; k < size; ++k) {
    const double phase = turns(static_cast<double>(k) / excitation.rate);
    excitation.samples[k] =
        excitation.options.amplitude * std::sin(2.0 * std::numbers::pi * (phase - std::floor(phase)));
  }
}

void add_chirp(Excitation& excitation, std::size_t size) {
  const ExcitationOptions& options = excitation.options;
  const double duration = static_cast<double>(size) / excitation.rate;
  const double lowest = options.lowest_hz;
  if (options.kind == ExcitationKind::linear_chirp) {
    const double slope = 0.5 * (options.highest_hz - lowest) / duration;
    add_sweep(excitation, size, [&](double t) { return (lowest + slope * t) * t; });
  } else {
    const double growth = std::log(options.highest_hz / lowest) / duration;  // 1/s
    add_sweep(excitation, size,
              [&](double t) { return lowest * (growth == 0.0 ? t : std::expm1(growth * t) / growth); });
  }
}

void add_multisine(Excitation& excitation, std::size_t size) {
  const ExcitationOptions& options = excitation.options;
  excitation.period = period_of(options, size);
  const std::vector<double> period = schroeder_multisine(excitation.period, band_of(options, excitation.rate));
  excitation.samples.reserve(excitation.period * options.periods);
  for (std::size_t i = 0; i < options.periods; ++i) {
    excitation.samples.insert(excitation.samples.end(), period.begin(), period.end());
  }
}

void add_relay(Excitation& excitation, std::size_t size) {
  const ExcitationOptions& options = excitation.options;
  const auto half = static_cast<std::size_t>(std::round(0.5 * excitation.rate / options.lowest_hz));
  excitation.samples.resize(size);
  for (std::size_t k = 0; k < size; ++k) {
    excitation.samples[k] = k / half % 2 == 0 ? options.amplitude : -options.amplitude;
  }
  excitation.period = 2 * half;
  remark_rounding(excitation, "the relay's frequency", options.lowest_hz,
                  excitation.rate / static_cast<double>(excitation.period), "Hz");
}

void scale_to_peak(std::vector<double>& samples, double amplitude) {
  const double peak = crest_factor(samples).peak;
  for (double& sample : samples) sample *= amplitude / peak;
}

void fade(Excitation& excitation) {
  const ExcitationOptions& options = excitation.options;
  std::vector<double>& samples = excitation.samples;
  if (options.fade_in == 0.0) return;
  const double length = options.fade_in * excitation.rate;
  const auto faded = std::min(samples.size(), static_cast<std::size_t>(std::ceil(length)));
  for (std::size_t k = 0; k < faded; ++k) {
    const double factor = 0.5 * (1.0 - std::cos(std::numbers::pi * static_cast<double>(k) / length));
    samples[k] *= factor;
    if (options.kind != ExcitationKind::multisine) samples[samples.size() - 1 - k] *= factor;
  }
}

Excitation made(const ExcitationOptions& options, double rate) {
  if (const auto problem = find_problem(options, rate)) {
    throw Error(ErrorCode::invalid_argument,
                fmt::format("`{}` {}; {}", problem->member, problem->what, problem->allowed));
  }
  const std::size_t size = size_of(options, rate);
  Excitation excitation;
  excitation.options = options;
  excitation.rate = rate;
  switch (options.kind) {
    case ExcitationKind::linear_chirp:
    case ExcitationKind::logarithmic_chirp:
      add_chirp(excitation, size);
      break;
    case ExcitationKind::multisine:
      add_multisine(excitation, size);
      scale_to_peak(excitation.samples, options.amplitude);
      break;
    case ExcitationKind::noise:
      excitation.samples = band_limited_noise(size, band_of(options, rate), options.seed);
      scale_to_peak(excitation.samples, options.amplitude);
      break;
    case ExcitationKind::relay:
      add_relay(excitation, size);
      break;
  }
  fade(excitation);
  excitation.crest = crest_factor(excitation.samples);
  const double duration = static_cast<double>(excitation.samples.size()) / rate;
  remark_rounding(excitation, "the duration", options.duration, duration, "s");
  if (duration * options.lowest_hz < 1.0) {
    excitation.remarks.push_back(warning({.code = FindingCode::excitation_shorter_than_cycle,
                                          .evidence = {{"duration", duration}, {"frequency", options.lowest_hz}}}));
  }
  return excitation;
}

double rate_for(const ExcitationOptions& options, const Device& device) {
  return options.rate.value_or(1.0 / device.loop().sampling_period);
}

}  // namespace

std::optional<OptionProblem> find_problem(const ExcitationOptions& options) {
  return find_problem(options, options.rate.value_or(default_excitation_rate));
}

std::optional<OptionProblem> find_problem(const ExcitationOptions& options, const Device& device) {
  return find_problem(options, rate_for(options, device));
}

Excitation excite(const ExcitationOptions& options) {
  return made(options, options.rate.value_or(default_excitation_rate));
}

Excitation excite(const ExcitationOptions& options, const Device& device) {
  Excitation excitation = made(options, rate_for(options, device));
  excitation.motion = device.parameters().motion;
  excitation.check = check_excitation(excitation, device);
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
