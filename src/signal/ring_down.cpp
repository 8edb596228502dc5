#include "zwidth/signal/ring_down.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::size_t shortest_window = 16;  // samples
constexpr std::size_t fewest_windows = 5;
constexpr double dead_share = 1e-9;     // of the largest window: below is rounding
constexpr double most_residual = 0.3;   // rms of ln |S|
constexpr int most_refinements = 6;     // of the frequency
constexpr double settled_shift = 1e-4;  // relative
constexpr double widest_change = 2.0;   // factor between the frequency asked for and the one found

struct Line {
  double slope = 0.0;
  double slope_error = 0.0;
  double residual = 0.0;  // rms
  double end = 0.0;       // value at the last point
};

Line line_through(const std::vector<double>& y, double spacing) {
  const auto n = static_cast<double>(y.size());
  double mean = 0.0;
  double moment = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    mean += y[i] / n;
    moment += (static_cast<double>(i) - 0.5 * (n - 1.0)) * y[i];
  }
  const double squares = n * (n * n - 1.0) / 12.0;
  const double slope = moment / squares;  // per point
  double rest = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    rest += std::pow(y[i] - mean - slope * (static_cast<double>(i) - 0.5 * (n - 1.0)), 2);
  }
  return {slope / spacing, std::sqrt(rest / (n - 2.0) / squares) / spacing, std::sqrt(rest / n),
          mean + slope * 0.5 * (n - 1.0)};
}

/// Complex amplitudes of the windows about the carrier, those of the beginning that are above the floor.
std::vector<std::complex<double>> windowed_amplitudes(std::span<const double> signal, double step, std::size_t length,
                                                      std::size_t hop, double floor) {
  std::vector<std::complex<double>> carrier(length);
  double sum = 0.0;
  for (std::size_t n = 0; n < length; ++n) {
    const double hann = 0.5 - 0.5 * std::cos(2.0 * pi * (static_cast<double>(n) + 0.5) / static_cast<double>(length));
    sum += hann;
    carrier[n] = std::polar(hann, -step * static_cast<double>(n));
  }
  std::vector<std::complex<double>> amplitudes;
  double largest = 0.0;
  for (std::size_t first = 0; first + length <= signal.size(); first += hop) {
    double mean = 0.0;
    for (std::size_t n = 0; n < length; ++n) mean += signal[first + n] / static_cast<double>(length);
    std::complex<double> value = 0.0;
    for (std::size_t n = 0; n < length; ++n) value += (signal[first + n] - mean) * carrier[n];
    value *= 2.0 / sum * std::polar(1.0, -step * static_cast<double>(first));
    largest = std::max(largest, std::abs(value));
    if (!(std::abs(value) > std::max(floor, dead_share * largest))) break;
    amplitudes.push_back(value);
  }
  return amplitudes;
}

}  // namespace

std::optional<RingDown> ring_down(std::span<const double> signal, double period, double frequency, double floor) {
  if (!(period > 0.0 && frequency > 0.0 && frequency * period < pi) ||
      !std::ranges::all_of(signal, [](double value) { return std::isfinite(value); })) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::ring_down_not_possible});
  }
  double w = frequency;
  for (int i = 0; i < most_refinements; ++i) {
    const auto length =
        std::max(shortest_window, static_cast<std::size_t>(std::lround(ring_window_cycles * 2.0 * pi / (w * period))));
    if (signal.size() < 3 * length) return std::nullopt;
    const std::size_t hop = length / 4;
    const double spacing = static_cast<double>(hop) * period;
    const auto amplitudes = windowed_amplitudes(signal, w * period, length, hop, floor);
    if (amplitudes.size() < fewest_windows) return std::nullopt;
    std::vector<double> logarithm;
    std::vector<double> phase;
    for (const std::complex<double>& value : amplitudes) {
      logarithm.push_back(std::log(std::abs(value)));
      const double turn = phase.empty() ? 0.0 : std::arg(value / amplitudes[phase.size() - 1]);
      phase.push_back(phase.empty() ? 0.0 : phase.back() + turn);
    }
    const double shift = line_through(phase, spacing).slope;
    w += shift;
    if (!(w > frequency / widest_change && w < frequency * widest_change && w * period < pi)) return std::nullopt;
    if (std::abs(shift) > settled_shift * w) continue;
    const Line growth = line_through(logarithm, spacing);
    if (growth.residual > most_residual) return std::nullopt;
    return RingDown{w, growth.slope, growth.slope_error, std::exp(growth.end), amplitudes.size()};
  }
  return std::nullopt;
}

}  // namespace zwidth
