#include "zwidth/identification/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "identification/excitation/excitation_check.hpp"
#include "identification/excitation/excitation_spectrum.hpp"
#include "zwidth/model/device_key.hpp"
#include "zwidth/require_valid.hpp"

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

OptionProblem not_above_zero(const char* member, double value, const char* what) {
  return option_problem(
      member,
      {.code = ProblemCode::not_finite_and_positive, .evidence = {{"value", value}}, .subjects = {{"what", what}}});
}

OptionProblem beyond_range(const char* member, double value, NumberRange range, std::vector<Subject> subjects) {
  return option_problem(member, {.code = ProblemCode::not_between,
                                 .evidence = {{"value", value}, {"least", range.least}, {"most", range.greatest}},
                                 .subjects = std::move(subjects)});
}

std::optional<OptionProblem> problem_of_size(const ExcitationOptions& options, double rate) {
  const double samples = options.duration * rate;
  const double size = std::round(samples);
  if (size >= 2.0 && size <= max_excitation_samples) return std::nullopt;
  // Of the two that make the samples, the one that does so by itself.
  const bool is_the_rate = options.rate && options.duration * default_excitation_rate <= max_excitation_samples &&
                           size > max_excitation_samples;
  return option_problem(is_the_rate ? "rate" : "duration",
                        {.code = ProblemCode::excitation_samples_out_of_range,
                         .evidence = {{"samples", samples}, {"least", 2.0}, {"most", max_excitation_samples}},
                         .subjects = {{"times", is_the_rate ? "duration" : "rate"}}});
}

std::optional<OptionProblem> problem_of_band(const ExcitationOptions& options, double rate) {
  const double nyquist = 0.5 * rate;
  const NumberRange band{options.lowest_hz, nyquist};
  if (!positive(options.lowest_hz)) return not_above_zero("lowest_hz", options.lowest_hz, "frequency in Hz");
  if (options.lowest_hz > nyquist) {
    return option_problem("lowest_hz", {.code = ProblemCode::frequency_out_of_range,
                                        .evidence = {{"hertz", options.lowest_hz}, {"nyquist", nyquist}}});
  }
  if (options.kind == ExcitationKind::relay || band.contains(options.highest_hz)) return std::nullopt;
  return beyond_range("highest_hz", options.highest_hz, band, {{"unit", "Hz"}});
}

std::optional<OptionProblem> find_problem(const ExcitationOptions& options, double rate) {
  if (!positive(options.amplitude)) return not_above_zero("amplitude", options.amplitude, "force");
  if (!positive_numbers.contains(options.amplitude)) {
    return beyond_range("amplitude", options.amplitude, positive_numbers, {});
  }
  if (!positive(rate)) return not_above_zero("rate", rate, "frequency in Hz");
  if (!positive(options.duration)) return not_above_zero("duration", options.duration, "time in s");
  if (auto problem = problem_of_size(options, rate)) return problem;
  if (auto problem = problem_of_band(options, rate)) return problem;
  const bool fades_once = options.kind == ExcitationKind::multisine;  // else the end fades as the start does
  if (const NumberRange fade{0.0, (fades_once ? 1.0 : 0.5) * options.duration}; !fade.contains(options.fade_in)) {
    return beyond_range("fade_in", options.fade_in, fade, {{"unit", "s"}});
  }
  if (options.stroke_limit && !positive(*options.stroke_limit)) {
    return not_above_zero("stroke_limit", *options.stroke_limit, "length");
  }
  const std::size_t samples = size_of(options, rate);
  if (options.kind == ExcitationKind::multisine) {
    if (options.periods < 1 || 2 * options.periods > samples) {
      return beyond_range("periods", static_cast<double>(options.periods), {1.0, static_cast<double>(samples / 2)},
                          {{"whole", "yes"}});
    }
    return internal::find_problem(period_of(options, samples), band_of(options, rate));
  }
  if (options.kind != ExcitationKind::noise) return std::nullopt;
  return internal::find_problem(samples, band_of(options, rate));
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
  remark_rounding(excitation, "frequency", options.lowest_hz, excitation.rate / static_cast<double>(excitation.period),
                  "Hz");
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
  require_valid(find_problem(options, rate));
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
  remark_rounding(excitation, "duration", options.duration, duration, "s");
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
