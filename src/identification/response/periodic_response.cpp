#include "identification/response/periodic_response.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <vector>

#include "counted.hpp"
#include "identification/response/encoder_step.hpp"
#include "identification/response/line_scatter.hpp"
#include "signal/fourier.hpp"

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;

/// Lines with less than this share of the strongest line's amplitude are not excited (-60 dB) ...
constexpr double excited_share = 1e-3;
/// ... nor are those whose power is less than this many times the variance that the noise gives their mean.
constexpr double least_signal_to_noise = 10.0;
/// Periods that one is given up of, so that the drift can be taken off by a moving average.
constexpr std::size_t least_periods_for_drift = 3;

/// A signal less its moving average over one period: every line k / period is kept exactly (a boxcar of one period is
/// zero there), while drift up to the third power of time goes, but for its constant part.
/// The result begins half a period later and is one period shorter.
std::vector<double> without_drift(std::span<const double> signal, std::size_t period) {
  // The average is centred: for an even period the two windows half a sample to either side are averaged.
  const std::size_t half = period / 2;
  const std::size_t size = signal.size() - 2 * half;
  const auto count = static_cast<double>(period);
  double sum = std::accumulate(signal.begin(), signal.begin() + static_cast<std::ptrdiff_t>(period), 0.0);
  std::vector<double> result(size);
  for (std::size_t i = 0; i < size; ++i) {
    double next = sum;
    if (i + period < signal.size()) next += signal[i + period] - signal[i];
    const double average = period % 2 == 1 ? sum / count : 0.5 * (sum + next) / count;
    result[i] = signal[i + half] - average;
    sum = next;
  }
  return result;
}

/// A signal less the line through the averages of its first and its last period.
std::vector<double> without_line(std::span<const double> signal, std::size_t period) {
  const auto length = static_cast<std::ptrdiff_t>(period);
  const auto count = static_cast<double>(period);
  const double first = std::accumulate(signal.begin(), signal.begin() + length, 0.0) / count;
  const double last = std::accumulate(signal.end() - length, signal.end(), 0.0) / count;
  const double slope = (last - first) / static_cast<double>(signal.size() - period);
  std::vector<double> result(signal.begin(), signal.end());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] -= first + slope * static_cast<double>(i);
  return result;
}

/// The spectra of two real signals from the transform of f + j x.
struct LinePair {
  Complex force;
  Complex output;
};
LinePair unpacked(const std::vector<Complex>& packed, std::size_t k) {
  const Complex plus = packed[k];
  const Complex minus = std::conj(packed[packed.size() - k]);
  return {0.5 * (plus + minus), Complex(0.0, -0.5) * (plus - minus)};
}

class Periods {
 public:
  Periods(std::vector<double> force, std::vector<double> output, std::size_t period)
      : force_(std::move(force)), output_(std::move(output)), period_(period), transform_(period) {
    const auto energy = [](const std::vector<double>& s) {
      return std::inner_product(s.begin(), s.end(), s.begin(), 0.0);
    };
    const double force_energy = energy(force_);
    const double output_energy = energy(output_);
    // Of equal size, so that neither drowns in the rounding of the other.
    if (force_energy > 0.0 && output_energy > 0.0) scale_ = std::sqrt(force_energy / output_energy);
  }

  [[nodiscard]] std::size_t count() const { return force_.size() / period_; }
  [[nodiscard]] double output_scale() const { return scale_; }

  void spectrum(std::size_t index, std::vector<Complex>& lines) {
    time_.resize(period_);
    for (std::size_t i = 0; i < period_; ++i) {
      time_[i] = {force_[index * period_ + i], scale_ * output_[index * period_ + i]};
    }
    transform_.forward(time_, lines);
  }

 private:
  std::vector<double> force_;
  std::vector<double> output_;
  std::size_t period_;
  FourierTransform transform_;
  std::vector<Complex> time_;
  double scale_ = 1.0;
};

/// How far each leading period is from the last, in power over all lines of force and output.
struct Sums {
  std::vector<LineScatter> lines;
  std::vector<double> distance;
};

Sums sum_periods(Periods& periods, std::size_t period, const Progress& progress) {
  Sums sums{std::vector<LineScatter>(period / 2 + 1), std::vector<double>(periods.count() - 1)};
  std::vector<Complex> last(period);
  std::vector<Complex> packed(period);
  periods.spectrum(periods.count() - 1, last);
  for (std::size_t k = 1; k < sums.lines.size(); ++k) {
    const auto [force, output] = unpacked(last, k);
    sums.lines[k].last_force = force;
    sums.lines[k].last_output = output;
  }
  for (std::size_t p = 0; p + 1 < periods.count(); ++p) {
    if (progress) progress(static_cast<double>(p) / static_cast<double>(periods.count()));
    periods.spectrum(p, packed);
    for (std::size_t i = 0; i < period; ++i) packed[i] -= last[i];
    for (std::size_t k = 1; k < sums.lines.size(); ++k) {
      const auto [force, output] = unpacked(packed, k);
      sums.lines[k].add(force, output);
      sums.distance[p] += std::norm(force) + std::norm(output);
    }
  }
  return sums;
}

/// Which lines the force excites: by its strength, and by its power over that of the noise that the scatter of the
/// periods shows around the line, so that of all lines without a force none passes but in one record of a thousand.
std::vector<bool> excited_lines(const std::vector<LineScatter>& lines, double count) {
  constexpr std::size_t reach = 16;
  constexpr double chance = 1e-3;
  std::vector<MeanForce> forces(lines.size());
  std::vector<double> noise(lines.size() + 1);  // cumulative
  double strongest = 0.0;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    forces[k] = mean_force(lines[k], count);
    noise[k + 1] = noise[k] + forces[k].variance;
    strongest = std::max(strongest, std::abs(forces[k].value));
  }
  std::vector<bool> excited(lines.size(), false);
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const auto& [value, variance] = forces[k];
    if (std::abs(value) < excited_share * strongest || std::norm(value) < least_signal_to_noise * variance / count) {
      continue;
    }
    const std::size_t first = k > reach ? k - reach : 1;
    const std::size_t last = std::min(lines.size(), k + reach + 1);
    const auto around = static_cast<double>(last - first);
    const double local = (noise[last] - noise[first]) / around;
    // P(F > x) = (1 + x / m)^-m for 2 and 2 m degrees of freedom.
    const double m = around * (count - 1.0);
    const double surprise = m * std::log1p(std::norm(value) * count / std::max(local, 1e-300) / m);
    excited[k] = surprise > std::log(static_cast<double>(lines.size()) / chance);
  }
  return excited;
}

}  // namespace

FrequencyResponse periodic_response(std::span<const double> force, std::span<const double> output,
                                    double sampling_period, const PeriodicRecord& record,
                                    const FrequencyResponseOptions& options, const Progress& progress) {
  const std::size_t period = record.period;
  const std::size_t whole = force.size() / period - record.skipped;
  const std::size_t start = record.skipped * period;
  const bool averaged_off = options.detrend && whole >= least_periods_for_drift;
  const auto prepared = [&](std::span<const double> signal) {
    const std::span<const double> used = signal.subspan(start, whole * period);
    if (!options.detrend) return std::vector<double>(used.begin(), used.end());
    return averaged_off ? without_drift(used, period) : without_line(used, period);
  };
  Periods periods(prepared(force), prepared(output), period);
  const Sums sums = sum_periods(periods, period, progress);
  const std::size_t transient = transient_repetitions(sums.distance);
  if (transient > 0 && record.transient == PeriodicRecord::Transient::skip) {
    PeriodicRecord shorter = record;
    shorter.skipped += transient;
    shorter.transient = PeriodicRecord::Transient::remark;
    return periodic_response(force, output, sampling_period, shorter, options, progress);
  }

  const auto count = static_cast<double>(periods.count());
  FrequencyResponse response;
  response.sampling_period = sampling_period;
  response.averages = count;
  const std::vector<bool> excited = excited_lines(sums.lines, count);
  // An encoder rounds by step^2 / 12 (white, over the lines of a period). Where the motion repeats to less than its
  // step, so does what it rounds off: the scatter of the periods does not show that part, and no average takes it off.
  const double step = encoder_step(output);
  const double rounding = step * step / 12.0 * static_cast<double>(period);
  for (std::size_t k = 1; k < sums.lines.size(); ++k) {
    if (!excited[k]) continue;
    const double turns = static_cast<double>(k) / (static_cast<double>(period) * sampling_period);
    ResponsePoint point = response_point(sums.lines[k], count, 2.0 * std::numbers::pi * turns);
    point.value /= periods.output_scale();
    point.variance /= periods.output_scale() * periods.output_scale();
    point.variance += std::max(0.0, rounding / std::norm(point.force) - count * point.variance);
    point.force *= 2.0 / static_cast<double>(period);
    response.points.push_back(point);
  }
  Finding averaged{.code = FindingCode::periods_averaged,
                   .evidence = {counted("samples", period),
                                {"period", static_cast<double>(period) * sampling_period},
                                counted("averaged", periods.count()),
                                counted("periods", force.size() / period)}};
  if (record.skipped > 0) averaged.evidence.push_back(counted("skipped", record.skipped));
  if (averaged_off) averaged.evidence.push_back({"of_drift", 1.0});
  response.remarks.push_back(note(std::move(averaged)));
  if (transient > 0) {
    response.remarks.push_back(
        warning({.code = FindingCode::transient_in_periods, .evidence = {counted("periods", transient)}}));
  }
  return response;
}

}  // namespace zwidth::internal
