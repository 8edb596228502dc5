#include "identification/response/welch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "identification/response/encoder_rounding.hpp"
#include "signal/averaged_spectra.hpp"
#include "signal/window_function.hpp"
#include "zwidth/error.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t shortest_segment = 8;
constexpr std::size_t longest_chosen_segment = 16384;
/// Independent averages that a chosen segment length leaves: enough that the noise is known to a fifth or so.
constexpr double wanted_averages = 16.0;
/// Lines on which the force has less than this share of its strongest line's power are not excited (-50 dB).
constexpr double excited_share = 1e-5;

/// The longest power of two that leaves the wanted averages.
Segments chosen_segments(std::size_t samples, const FrequencyResponseOptions& options) {
  std::size_t length = std::min(longest_chosen_segment, std::bit_floor(samples / 2));
  while (length / 2 >= shortest_segment &&
         segments_of(samples, length, options.window, options.overlap).averages < wanted_averages) {
    length /= 2;
  }
  return segments_of(samples, length, options.window, options.overlap);
}

struct Line {
  Complex value;
  double coherence = 0.0;
};

/// H and coherence on every line; zero where there is no power at all.
std::vector<Line> ratios(const AveragedSpectra& sums, ResponseEstimator estimator) {
  std::vector<Line> lines(sums.ff.size());
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const Complex cross(sums.fx_real[k], sums.fx_imag[k]);
    if (sums.ff[k] <= 0.0 || sums.xx[k] <= 0.0 || cross == 0.0) continue;
    lines[k].value =
        (estimator == ResponseEstimator::h1 ? cross / sums.ff[k] : sums.xx[k] / std::conj(cross)) / sums.output_scale;
    lines[k].coherence = std::min(1.0, std::norm(cross) / (sums.ff[k] * sums.xx[k]));
  }
  return lines;
}

/// What the window's smearing added to line k, to second order: with the force's power S as weight and m the second
/// moment of the lobe,  E H = H + m (H'' / 2 + H' S' / S).
Complex smearing(const std::vector<Line>& lines, const AveragedSpectra& sums, std::size_t k, double moment) {
  if (k < 2 || k + 1 >= lines.size() || lines[k - 1].value == 0.0 || lines[k + 1].value == 0.0) return 0.0;
  const Complex curvature = lines[k + 1].value - 2.0 * lines[k].value + lines[k - 1].value;
  const Complex slope = 0.5 * (lines[k + 1].value - lines[k - 1].value);
  const double tilt = std::clamp(0.5 * (sums.ff[k + 1] - sums.ff[k - 1]) / sums.ff[k], -1.0, 1.0);
  return moment * (0.5 * curvature + slope * tilt);
}

/// What taking off the smearing makes of the noise's variance: the weights of three lines are -m/2, 1 + m, -m/2, and
/// the errors of the response, products of two spectra, are correlated like squares.
double unsmearing_gain(Window window) {
  const double m = lobe_second_moment(window);
  const double one = std::pow(noise_correlation(window, 1), 2);
  const double two = std::pow(noise_correlation(window, 2), 2);
  return (1.0 + m) * (1.0 + m) + 0.5 * m * m * (1.0 + two) - 2.0 * m * (1.0 + m) * one;
}

/// The line holds little but what leaks from its neighbours, as beside the edge of a band.
bool is_leakage(const std::vector<double>& power, std::size_t k) {
  constexpr double least_share_of_next = 0.25;
  constexpr double least_share_of_second = 0.05;
  const auto at = [&](std::size_t line) { return line < power.size() ? power[line] : 0.0; };
  return power[k] < least_share_of_next * std::max(at(k - 1), at(k + 1)) ||
         power[k] < least_share_of_second * std::max(k >= 2 ? at(k - 2) : 0.0, at(k + 2));
}

/// Differencing weights a line's power by this.
double differencing_gain(double angle) { return 4.0 * std::sin(0.5 * angle) * std::sin(0.5 * angle); }

void remark_resolution(FrequencyResponse& response, double coarsest_frequency, double share) {
  constexpr double noticeable = 0.1;
  if (share < noticeable) return;
  response.remarks.push_back(warning({.code = FindingCode::segments_too_short,
                                      .evidence = {{"frequency", coarsest_frequency / (2.0 * std::numbers::pi)},
                                                   {"smearing", share},
                                                   {"threshold", noticeable}}}));
}

/// Segments at either end of a record in which the window has not yet, or no longer, its full weight.
std::size_t ramp_segments(const Segments& segments) { return (segments.length - 1) / segments.step; }

/// A signal after as many samples at rest as give its first ones the full weight of the window.
std::vector<double> after_rest(std::span<const double> signal, std::size_t rest) {
  std::vector<double> longer(rest, signal.front());
  longer.insert(longer.end(), signal.begin(), signal.end());
  return longer;
}

/// Signals, as they are cut into segments.
struct Cut {
  std::span<const double> force;
  std::span<const double> output;
  Segments segments;
  SignalForm form = SignalForm::differenced;
  bool rested = false;  ///< rest was put before
};

/// By line: the share of the force's power that lies in the segments at the ends where the window's weight changes. A
/// frequency that a sweep passes there is weighed unlike its response, which comes later. Empty for few segments.
std::vector<double> end_shares(const Cut& cut, const AveragedSpectra& sums) {
  constexpr std::size_t few = 4;
  const std::size_t ramp = ramp_segments(cut.segments);
  if (ramp == 0 || cut.segments.count < few * ramp) return {};
  Segments ends = cut.segments;
  ends.count = ramp;
  const std::size_t size = (ramp - 1) * ends.step + ends.length + (cut.form == SignalForm::differenced ? 1 : 0);
  const auto add = [&](std::vector<double>& shares, std::size_t start) {
    const AveragedSpectra end =
        averaged_spectra(cut.force.subspan(start, size), cut.output.subspan(start, size), ends, cut.form);
    for (std::size_t k = 1; k < shares.size(); ++k) {
      if (sums.ff[k] > 0.0) shares[k] += end.ff[k] / sums.ff[k];
    }
  };
  std::vector<double> shares(sums.ff.size(), 0.0);
  if (!cut.rested) add(shares, 0);
  add(shares, (cut.segments.count - ramp) * ends.step);
  return shares;
}

/// The lines that the force excites, with their noise.
struct Points {
  std::vector<ResponsePoint> points;
  std::size_t at_ends = 0;      ///< lines left out because only the ends of the record excite them
  double worst_smearing = 0.0;  ///< relative to the magnitude, where it is more than noise
  double worst_frequency = 0.0;
};

Points points_of(const AveragedSpectra& sums, const Cut& cut, double sampling_period,
                 const FrequencyResponseOptions& options) {
  constexpr double most_at_ends = 0.8;
  const std::vector<Line> lines = ratios(sums, options.estimator);
  const std::vector<double> shares = options.lines_at_ends ? std::vector<double>{} : end_shares(cut, sums);
  const double moment = lobe_second_moment(options.window);
  const double noise_gain = unsmearing_gain(options.window);
  const double line_angle = 2.0 * std::numbers::pi / static_cast<double>(cut.segments.length);
  const std::size_t first = main_lobe_half_width(options.window);
  const double window_sum = std::accumulate(cut.segments.window.begin(), cut.segments.window.end(), 0.0);
  std::vector<double> power(lines.size());
  for (std::size_t k = first; k < lines.size(); ++k) {
    const double gain =
        cut.form == SignalForm::differenced ? differencing_gain(line_angle * static_cast<double>(k)) : 1.0;
    power[k] = sums.ff[k] / gain;
  }
  const double strongest = *std::max_element(power.begin(), power.end());
  Points result;
  for (std::size_t k = first; k < lines.size(); ++k) {
    const Line& line = lines[k];
    if (power[k] < excited_share * strongest || is_leakage(sums.ff, k) || line.coherence <= 0.0) continue;
    if (!shares.empty() && shares[k] > most_at_ends) {
      ++result.at_ends;
      continue;
    }
    ResponsePoint point;
    point.frequency = line_angle * static_cast<double>(k) / sampling_period;
    const Complex smeared = smearing(lines, sums, k, moment);
    point.value = line.value - smeared;
    point.coherence = line.coherence;
    const double noise = std::norm(line.value) * (1.0 - line.coherence) / line.coherence;
    // What is left of the smearing is of its second order.
    const double left = std::norm(smeared) / std::abs(line.value);
    point.variance = noise_gain * noise / std::max(cut.segments.averages - 1.0, 1.0) + left * left;
    // The sums hold 2 F, of a window that leaves an amplitude its half times the sum of the window.
    point.force = std::sqrt(power[k] / static_cast<double>(cut.segments.count)) / window_sum;
    result.points.push_back(point);
    const double share = std::abs(smeared) / std::abs(line.value);
    if (std::norm(smeared) > point.variance && share > result.worst_smearing) {
      result.worst_smearing = share;
      result.worst_frequency = point.frequency;
    }
  }
  return result;
}

void add_remarks(FrequencyResponse& response, const Cut& cut, const Points& points, double sampling_period) {
  const Segments& segments = cut.segments;
  Finding averaged{.code = FindingCode::segments_averaged,
                   .evidence = {counted("segments", segments.count),
                                counted("samples", segments.length),
                                {"spacing", 1.0 / (static_cast<double>(segments.length) * sampling_period)},
                                {"averages", segments.averages}}};
  if (cut.form == SignalForm::differenced) averaged.subjects.push_back({"form", "differenced"});
  response.remarks.push_back(note(std::move(averaged)));
  if (cut.rested) response.remarks.push_back(note({.code = FindingCode::begins_at_rest}));
  if (points.at_ends > 0) {
    response.remarks.push_back(
        note({.code = FindingCode::lines_of_record_ends, .evidence = {counted("lines", points.at_ends)}}));
  }
  constexpr double fewest_averages = 2.0;
  if (segments.averages < fewest_averages) {
    response.remarks.push_back(
        warning({.code = FindingCode::too_few_averages,
                 .evidence = {{"averages", segments.averages}, {"threshold", fewest_averages}}}));
  }
  remark_resolution(response, points.worst_frequency, points.worst_smearing);
}

/// A record is differenced against drift, which spends a sample.
SignalForm form_of(const FrequencyResponseOptions& options) {
  return options.detrend && options.output != OutputQuantity::acceleration ? SignalForm::differenced
                                                                           : SignalForm::as_recorded;
}

std::size_t samples_left(std::size_t samples, SignalForm form) {
  return samples - (form == SignalForm::differenced ? 1 : 0);
}

}  // namespace

bool begins_at_rest(std::span<const double> force, std::span<const double> output) {
  constexpr double nil = 0.05;        // of the largest force
  constexpr double still = 0.2;       // of the usual step
  constexpr std::size_t samples = 8;  // of a step: one alone may be noise, or a count of the encoder
  double largest_force = 0.0;
  double steps = 0.0;
  for (std::size_t i = 0; i + samples < output.size(); ++i) {
    largest_force = std::max(largest_force, std::abs(force[i]));
    steps += (output[i + samples] - output[i]) * (output[i + samples] - output[i]);
  }
  const double usual_step = std::sqrt(steps / static_cast<double>(output.size() - samples));
  return std::abs(force[0]) <= nil * largest_force && std::abs(output[samples] - output[0]) <= still * usual_step;
}

std::size_t welch_segment_length(std::size_t samples, const FrequencyResponseOptions& options) {
  return options.segment_length.value_or(chosen_segments(samples_left(samples, form_of(options)), options).length);
}

FrequencyResponse welch_response(std::span<const double> force, std::span<const double> output, double sampling_period,
                                 const FrequencyResponseOptions& options, const Progress& progress) {
  Cut cut{force, output, {}, form_of(options)};
  const std::size_t samples = samples_left(force.size(), cut.form);
  if (options.segment_length && (*options.segment_length < shortest_segment || *options.segment_length > samples)) {
    Problem problem{.code = ProblemCode::segment_not_in_record,
                    .evidence = {counted("value", *options.segment_length), counted("least", shortest_segment),
                                 counted("most", samples)}};
    if (samples < force.size()) problem.subjects.push_back({"shortened", "differences"});
    refuse_member("segment_length", std::move(problem));
  }
  cut.segments = options.segment_length ? segments_of(samples, *options.segment_length, options.window, options.overlap)
                                        : chosen_segments(samples, options);
  std::vector<double> rested_force;
  std::vector<double> rested_output;
  if (options.begins_at_rest.value_or(begins_at_rest(force, output))) {
    const std::size_t rest = ramp_segments(cut.segments) * cut.segments.step;
    rested_force = after_rest(force, rest);
    rested_output = after_rest(output, rest);
    cut.force = rested_force;
    cut.output = rested_output;
    cut.rested = true;
    cut.segments = segments_of(samples + rest, cut.segments.length, options.window, options.overlap);
  }
  const AveragedSpectra sums = averaged_spectra(cut.force, cut.output, cut.segments, cut.form, progress);
  Points points = points_of(sums, cut, sampling_period, options);
  if (options.output == OutputQuantity::position) {
    const SweepRounding rounding(force, output);
    for (ResponsePoint& point : points.points) point.variance += rounding.variance(point.value);
  }
  FrequencyResponse response;
  response.sampling_period = sampling_period;
  response.averages = cut.segments.averages;
  // In units of the variance that taking off the smearing has raised.
  response.line_correlation = std::max(1.0, line_correlation(options.window) / unsmearing_gain(options.window));
  add_remarks(response, cut, points, sampling_period);
  response.points = std::move(points.points);
  return response;
}

}  // namespace zwidth::internal
