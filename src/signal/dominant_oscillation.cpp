#include "zwidth/signal/dominant_oscillation.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include "signal/window_function.hpp"
#include "zwidth/error.hpp"
#include "zwidth/signal/power_density.hpp"

namespace zwidth {
namespace {

constexpr std::size_t fewest_samples = 64;
constexpr std::size_t most_samples = std::size_t{1} << 17U;
constexpr std::size_t slowest_line = 4;
constexpr std::size_t lobe = 3;              // lines to either side that a windowed sine fills
constexpr double power_of_hann = 3.0 / 8.0;  // mean square of the window

/// Least-squares straight line taken out.
std::vector<double> detrended(std::span<const double> signal) {
  const auto n = static_cast<double>(signal.size());
  double mean = 0.0;
  double slope = 0.0;
  for (std::size_t i = 0; i < signal.size(); ++i) {
    const double t = static_cast<double>(i) - 0.5 * (n - 1.0);
    mean += signal[i] / n;
    slope += t * signal[i];
  }
  slope /= n * (n * n - 1.0) / 12.0;
  std::vector<double> result;
  result.reserve(signal.size());
  for (std::size_t i = 0; i < signal.size(); ++i) {
    result.push_back(signal[i] - mean - slope * (static_cast<double>(i) - 0.5 * (n - 1.0)));
  }
  return result;
}

/// Of a sine of w T = step radians a sample: its amplitude, seen through a Hann window.
double amplitude_at(std::span<const double> signal, double step) {
  const std::vector<double> window = internal::window_function(Window::hann, signal.size());
  std::complex<double> sum = 0.0;
  double weight = 0.0;
  for (std::size_t i = 0; i < signal.size(); ++i) {
    sum += window[i] * signal[i] * std::polar(1.0, -step * static_cast<double>(i));
    weight += window[i];
  }
  return 2.0 * std::abs(sum) / weight;
}

}  // namespace

std::optional<DominantOscillation> dominant_oscillation(std::span<const double> signal, double period) {
  if (!(period > 0.0) || !std::isfinite(period) ||
      !std::ranges::all_of(signal, [](double value) { return std::isfinite(value); })) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::period_or_samples_not_possible});
  }
  const std::size_t count = std::min(signal.size() / 2, most_samples);
  if (count < fewest_samples) return std::nullopt;
  const std::vector<double> moved = detrended(signal.last(count));
  std::vector<double> windowed = moved;
  const std::vector<double> window = internal::window_function(Window::hann, count);
  for (std::size_t i = 0; i < count; ++i) windowed[i] *= window[i];
  const PowerDensity density = power_density(windowed, 1.0 / period);
  const std::vector<double>& power = density.values;
  const auto highest = std::max_element(power.begin() + 1, power.end() - 1);
  const auto peak = static_cast<std::size_t>(highest - power.begin());
  if (!(*highest > 0.0) || peak < slowest_line) return std::nullopt;
  double shift = 0.0;
  const double left = std::log(std::max(power[peak - 1], 1e-300));
  const double middle = std::log(*highest);
  const double right = std::log(std::max(power[peak + 1], 1e-300));
  if (const double bend = left - 2.0 * middle + right; bend < 0.0) shift = 0.5 * (left - right) / bend;
  double of_peak = 0.0;
  double all = 0.0;
  for (std::size_t i = 1; i < power.size(); ++i) {
    all += power[i];
    if (i + lobe >= peak && i <= peak + lobe) of_peak += power[i];
  }
  const double line = 2.0 * std::numbers::pi * density.step_hz;
  DominantOscillation result;
  result.frequency = line * (static_cast<double>(peak) + shift);
  result.amplitude = std::sqrt(2.0 * of_peak * density.step_hz / power_of_hann);
  result.share = of_peak / all;
  result.resolution = line;
  const std::span<const double> stretch = moved;
  const double step = result.frequency * period;
  result.change = amplitude_at(stretch.last(count / 2), step) / amplitude_at(stretch.first(count / 2), step);
  return result;
}

}  // namespace zwidth
