#include "identification/response/period_detection.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <vector>

#include "signal/fourier.hpp"

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t most_samples = std::size_t{1} << 19U;
constexpr std::size_t least_period = 8;
constexpr double least_correlation = 0.98;
/// A longer lag that fits this much better is the true period: the shorter one is a beat of neighbouring lines.
constexpr double clearly_better = 0.2;
/// Below this 1 - r is rounding: every multiple of the period is as good.
constexpr double rounding = 1e-9;

/// r[lag] = sum s[i] s[i + lag] over the overlap, divided by the energies of the two parts that overlap.
std::vector<double> autocorrelation(const std::vector<double>& signal, std::size_t most_lag) {
  const std::size_t padded = fast_length(signal.size() + most_lag + 1);
  FourierTransform transform(padded);
  std::vector<Complex> time(padded);
  std::vector<Complex> lines(padded);
  std::copy(signal.begin(), signal.end(), time.begin());
  transform.forward(time, lines);
  for (Complex& line : lines) line = std::norm(line);
  transform.inverse(lines, time);

  std::vector<double> energy(signal.size() + 1);
  for (std::size_t i = 0; i < signal.size(); ++i) energy[i + 1] = energy[i] + signal[i] * signal[i];
  std::vector<double> correlation(most_lag + 1);
  for (std::size_t lag = 0; lag <= most_lag; ++lag) {
    const double early = energy[signal.size() - lag];
    const double late = energy.back() - energy[lag];
    correlation[lag] = early > 0.0 && late > 0.0 ? time[lag].real() / std::sqrt(early * late) : 0.0;
  }
  return correlation;
}

/// The period of a signal in white noise: the noise lowers all correlations but the first alike, so that those at one,
/// two and three periods are the highest and equal. Other signals' correlations fall from period to period.
std::optional<std::size_t> period_in_noise(const std::vector<double>& correlation, std::size_t fallen) {
  constexpr double least = 0.5;
  constexpr double alike = 0.04;
  const std::size_t from = std::max(fallen, least_period);
  const auto begin = correlation.begin();
  const auto place = [&](std::size_t lag) { return begin + static_cast<std::ptrdiff_t>(lag); };
  const std::size_t longest = (correlation.size() - 1) / 3;  // of which three multiples are known
  if (longest <= from) return std::nullopt;
  const double highest = *std::max_element(place(from), place(longest + 1));
  if (highest < least) return std::nullopt;
  for (std::size_t lag = from; lag <= longest; ++lag) {
    if (correlation[lag] < highest - alike || correlation[lag] < correlation[lag - 1] ||
        correlation[lag] < correlation[lag + 1]) {
      continue;
    }
    const bool repeats = std::abs(correlation[2 * lag] - correlation[lag]) < alike &&
                         std::abs(correlation[3 * lag] - correlation[lag]) < alike;
    if (repeats) return lag;
  }
  return std::nullopt;
}

std::optional<std::size_t> period_of(std::span<const double> signal) {
  if (signal.size() < 2 * least_period) return std::nullopt;
  const double mean = std::accumulate(signal.begin(), signal.end(), 0.0) / static_cast<double>(signal.size());
  std::vector<double> centred(signal.size());
  std::transform(signal.begin(), signal.end(), centred.begin(), [mean](double value) { return value - mean; });

  const std::size_t most_lag = signal.size() / 2;
  const std::vector<double> correlation = autocorrelation(centred, 3 * (signal.size() / 4));  // three of four periods
  const auto first_fall = std::find_if(correlation.begin(), correlation.end(), [](double r) { return r < 0.5; });
  std::optional<std::size_t> best;
  const auto fallen = static_cast<std::size_t>(first_fall - correlation.begin());
  for (std::size_t lag = std::max(fallen, least_period); lag <= most_lag; ++lag) {
    const double r = correlation[lag];
    const bool is_peak = r >= correlation[lag - 1] && (lag == most_lag || r > correlation[lag + 1]);
    if (!is_peak || r < least_correlation) continue;
    const double best_defect = best ? 1.0 - correlation[*best] : 1.0;
    if (!best || (best_defect > rounding && 1.0 - r < clearly_better * best_defect)) best = lag;
  }
  return best ? best : period_in_noise(correlation, fallen);
}

}  // namespace

std::optional<std::size_t> detect_period(std::span<const double> signal) {
  const std::size_t size = std::min(signal.size(), most_samples);
  const std::span<const double> middle = signal.subspan((signal.size() - size) / 2, size);
  // The excitation may begin some time after the record does.
  for (const std::size_t late : {std::size_t{0}, size / 8, size / 4, size / 2}) {
    if (const auto period = period_of(middle.subspan(late))) return period;
  }
  return std::nullopt;
}

}  // namespace zwidth::internal
