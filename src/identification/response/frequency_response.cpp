#include "zwidth/identification/frequency_response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "counted.hpp"
#include "identification/response/line_response.hpp"
#include "identification/response/local_polynomial.hpp"
#include "identification/response/period_detection.hpp"
#include "identification/response/periodic_response.hpp"
#include "identification/response/welch.hpp"
#include "zwidth/error.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
using namespace internal;
namespace {

using Excited = FrequencyResponseOptions::Excitation;

constexpr std::size_t fewest_samples = 16;

[[noreturn]] void refuse(const Problem& problem) { throw Error(ErrorCode::invalid_argument, problem); }

void check_samples(std::span<const double> signal, const char* name) {
  const auto bad = std::find_if_not(signal.begin(), signal.end(), [](double value) { return std::isfinite(value); });
  if (bad != signal.end())
    refuse({.code = ProblemCode::sample_not_a_number,
            .evidence = {counted("sample", static_cast<std::size_t>(bad - signal.begin())), {"value", *bad}},
            .subjects = {{"signal", name}}});
}

void check(std::span<const double> force, std::span<const double> output, double sampling_period,
           const FrequencyResponseOptions& options) {
  if (force.size() != output.size()) {
    refuse({.code = ProblemCode::force_and_motion_of_two_lengths,
            .evidence = {counted("force", force.size()), counted("motion", output.size())}});
  }
  if (force.size() < fewest_samples) {
    refuse({.code = ProblemCode::record_of_few_samples,
            .evidence = {counted("samples", force.size()), counted("least", fewest_samples)}});
  }
  if (!(std::isfinite(sampling_period) && sampling_period > 0.0)) {
    refuse({.code = ProblemCode::not_finite_and_positive,
            .evidence = {{"value", sampling_period}},
            .subjects = {{"name", "sampling period"}, {"unit", "s"}}});
  }
  check_samples(force, "force");
  check_samples(output, "motion");
  const auto constant = [](std::span<const double> signal) {
    return std::all_of(signal.begin(), signal.end(), [&](double value) { return value == signal.front(); });
  };
  if (constant(force)) refuse({.code = ProblemCode::signal_is_constant, .subjects = {{"signal", "force"}}});
  if (constant(output)) refuse({.code = ProblemCode::signal_is_constant, .subjects = {{"signal", "motion"}}});
  if (!(options.overlap >= 0.0 && options.overlap < 1.0)) {
    refuse_member("overlap", {.code = ProblemCode::no_share_below_one, .evidence = {{"value", options.overlap}}});
  }
  const double lowest = options.lowest.value_or(0.0);
  const double highest = options.highest.value_or(std::numeric_limits<double>::infinity());
  if (!(lowest >= 0.0 && highest > lowest)) {
    refuse_member("highest",
                  {.code = ProblemCode::no_rising_band, .evidence = {{"lowest", lowest}, {"highest", highest}}});
  }
}

void check_period(std::size_t samples, std::size_t period, std::size_t skipped) {
  if (period < 2 || period > samples / 2) {
    refuse_member("period", {.code = ProblemCode::period_not_in_record,
                             .evidence = {counted("value", period), counted("samples", samples)}});
  }
  if (samples / period < skipped + 2) {
    refuse_member("skip_periods", {.code = ProblemCode::periods_all_skipped,
                                   .evidence = {counted("value", skipped), counted("periods", samples / period)}});
  }
}

/// The lines asked for in rad per sample, rising.
std::vector<double> angles_of(const FrequencyResponseOptions& options, double sampling_period) {
  std::vector<double> angles;
  for (const double line : options.lines) {
    if (!(std::isfinite(line) && line > 0.0))
      refuse_member("lines", {.code = ProblemCode::not_finite_and_positive,
                              .evidence = {{"value", line}},
                              .subjects = {{"name", "line"}, {"unit", "rad/s"}}});
    if (!(line * sampling_period < std::numbers::pi)) {
      refuse_member("lines",
                    {.code = ProblemCode::line_beyond_nyquist,
                     .evidence = {{"hertz", line / (2.0 * std::numbers::pi)}, {"nyquist", 0.5 / sampling_period}}});
    }
    angles.push_back(line * sampling_period);
  }
  std::ranges::sort(angles);
  const auto twice = std::ranges::adjacent_find(angles);
  if (twice != angles.end()) {
    refuse_member("lines", {.code = ProblemCode::line_twice,
                            .evidence = {{"hertz", *twice / (2.0 * std::numbers::pi * sampling_period)}}});
  }
  return angles;
}

FrequencyResponse estimate(std::span<const double> force, std::span<const double> output, double sampling_period,
                           const FrequencyResponseOptions& options, const Progress& progress) {
  if (!options.lines.empty()) {
    return line_response(force, output, sampling_period, angles_of(options, sampling_period), options, progress);
  }
  if (options.excitation == Excited::aperiodic) {
    return welch_response(force, output, sampling_period, options, progress);
  }
  const auto record_of = [&](std::size_t period) -> PeriodicRecord {
    check_period(force.size(), period, options.skip_periods);
    return {period, options.skip_periods,
            options.skip_periods == 0 ? PeriodicRecord::Transient::skip : PeriodicRecord::Transient::remark};
  };
  if (options.period && options.excitation == Excited::periodic) {
    return periodic_response(force, output, sampling_period, record_of(*options.period), options, progress);
  }
  if (const auto tone = options.excitation == Excited::detect ? only_tone(force) : std::nullopt) {
    return line_response(force, output, sampling_period, {*tone}, options, progress);
  }
  if (const auto period = detect_period(force)) {
    FrequencyResponse response =
        periodic_response(force, output, sampling_period, record_of(*period), options, progress);
    response.remarks.insert(response.remarks.begin(),
                            note({.code = FindingCode::force_repeats, .evidence = {counted("samples", *period)}}));
    return response;
  }
  if (options.excitation == Excited::periodic) {
    refuse({.code = ProblemCode::force_does_not_repeat});
  }
  return welch_response(force, output, sampling_period, options, progress);
}

/// Velocity and acceleration as position; the Nyquist line, where jw has no real counterpart in samples, is left out.
void to_position(FrequencyResponse& response, OutputQuantity output, double sampling_period) {
  if (output == OutputQuantity::position) return;
  const double nyquist = std::acos(-1.0) / sampling_period;
  std::erase_if(response.points, [&](const ResponsePoint& point) { return point.frequency > 0.999999 * nyquist; });
  for (ResponsePoint& point : response.points) {
    const std::complex<double> jw(0.0, point.frequency);
    const std::complex<double> factor = output == OutputQuantity::velocity ? 1.0 / jw : 1.0 / (jw * jw);
    point.value *= factor;
    point.variance *= std::norm(factor);
  }
  response.remarks.push_back(note({.code = output == OutputQuantity::velocity ? FindingCode::velocity_integrated
                                                                              : FindingCode::acceleration_integrated}));
}

void to_position_in_band(FrequencyResponse& response, const FrequencyResponseOptions& options, double sampling_period) {
  to_position(response, options.output, sampling_period);
  std::erase_if(response.points, [&](const ResponsePoint& point) {
    return point.frequency < options.lowest.value_or(0.0) ||
           point.frequency > options.highest.value_or(std::numeric_limits<double>::infinity());
  });
}

}  // namespace

FrequencyResponse internal::response_of_whole_record(std::span<const double> force, std::span<const double> output,
                                                     double sampling_period, double spacing,
                                                     const FrequencyResponseOptions& options) {
  check(force, output, sampling_period, options);
  FrequencyResponse response = local_polynomial_response(force, output, sampling_period, spacing, options);
  to_position_in_band(response, options, sampling_period);
  return response;
}

FrequencyResponseOptions::Excitation excitation_of(const FrequencyResponseOptions& options) {
  if (options.excitation != Excited::detect) return options.excitation;
  if (options.period) return Excited::periodic;
  return options.segment_length ? Excited::aperiodic : Excited::detect;
}

FrequencyResponse frequency_response(std::span<const double> force, std::span<const double> output,
                                     double sampling_period, const FrequencyResponseOptions& options,
                                     const Progress& progress) {
  check(force, output, sampling_period, options);
  FrequencyResponse response = estimate(force, output, sampling_period, options, progress);
  to_position_in_band(response, options, sampling_period);
  if (progress) progress(1.0);
  return response;
}

double confidence_radius(const ResponsePoint& point, double averages) {
  // P(F > x) = (1 + x / m)^-m for 2 and 2 m degrees of freedom; exp(-x) in the limit.
  constexpr double outside = 0.05;
  if (averages == 0.0) {
    return point.variance == 0.0 ? std::numeric_limits<double>::infinity()
                                 : std::sqrt(-std::log(outside) * point.variance);
  }
  if (averages < 2.0) return std::numeric_limits<double>::infinity();
  const double m = averages - 1.0;
  return std::sqrt(point.variance * m * std::expm1(-std::log(outside) / m));
}

}  // namespace zwidth
