#include "zwidth/stability/bode_points.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "stability/loop/damper_response.hpp"

namespace zwidth {
using namespace internal;
namespace {

using std::numbers::pi;
constexpr double degrees_per_radian = 180.0 / pi;

double decibels(std::complex<double> value) { return 20.0 * std::log10(std::abs(value)); }

/// Angle from `before` to `after`, degrees_per_radian in (-180, 180].
double turn(std::complex<double> before, std::complex<double> after) {
  return std::arg(after / before) * degrees_per_radian;
}

/// An interval is halved while its ends differ by more than this: less than a line width on paper.
constexpr double bend_db = 0.5;
constexpr double bend_degrees = 3.0;
/// Narrower than any mode that a picture can show; it also ends the halving at the poles of undamped modes.
constexpr double least_ratio = 1e-6;
constexpr std::size_t most_frequencies = 20000;

/// Whether the chord over [low, high] strays from the response at their middle.
bool bends(const DelayedResponse& response, double low, double middle, double high) {
  const std::complex<double> at_low = response.value(low);
  const std::complex<double> at_middle = response.value(middle);
  const std::complex<double> at_high = response.value(high);
  const double stray_db = decibels(at_middle) - 0.5 * (decibels(at_low) + decibels(at_high));
  const double first = turn(at_low, at_middle);
  const double second = turn(at_middle, at_high);
  return !(std::abs(stray_db) < bend_db / 4) || std::abs(first) > 60 || std::abs(second) > 60 ||
         std::abs(first - second) > bend_degrees;
}

void add_mode(std::vector<double>& frequencies, const Mode& mode, double period) {
  // Multiples of the half-width zeta w around the peak.
  for (const double width : {-8.0, -4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    double frequency = mode.frequency * (1.0 + width * std::min(mode.damping_ratio, 0.1));
    if (period > 0.0) frequency = std::abs(std::remainder(frequency, 2.0 * pi / period));
    frequencies.push_back(frequency);
  }
}

}  // namespace

DelayedResponse delayed_response(ModalForm form, double delay) {
  return {[form = std::move(form)](double frequency) { return response(form, frequency); }, delay, 0.0};
}

DelayedResponse delayed_response(FilteredPlant plant, VirtualDamper damper) {
  const double delay = static_cast<double>(plant.delay_samples) * plant.period;
  if (plant.at_nyquist && plant.delay_samples % 2 != 0) *plant.at_nyquist *= -1.0;  // P(-1) has the delay's (-1)^l
  plant.delay_samples = 0;
  return {[plant = std::move(plant), damper, delay](double frequency) {
            const std::complex<double> undelayed = response(plant, frequency);
            if (damper.damping == 0.0) return undelayed;
            const std::complex<double> loop =
                damper_response(damper, plant.period, frequency) * undelayed * std::polar(1.0, -frequency * delay);
            return undelayed / (1.0 + loop);
          },
          delay, damper.damping == 0.0 ? 0.0 : delay};
}

std::vector<double> bode_frequencies(std::span<const DelayedResponse> responses, FrequencyRange range,
                                     std::span<const Mode> modes, double period, std::size_t points) {
  std::vector<double> frequencies;
  for (const Mode& mode : modes) add_mode(frequencies, mode, period);
  std::erase_if(frequencies, [&](double w) { return !(w > range.from && w < range.to); });
  const double span = std::log(range.to / range.from);
  const std::size_t intervals = std::max<std::size_t>(points, 2) - 1;
  for (std::size_t i = 0; i < intervals; ++i) {
    frequencies.push_back(range.from * std::exp(span * static_cast<double>(i) / static_cast<double>(intervals)));
  }
  frequencies.push_back(range.to);
  for (const DelayedResponse& response : responses) {
    constexpr double part_of_turn = 0.5;  // rad between samples
    if (response.loop_delay == 0.0) continue;
    const double step = std::max(part_of_turn / response.loop_delay, range.to / (0.5 * most_frequencies));
    for (double w = range.from + step; w < range.to; w += step) frequencies.push_back(w);
  }
  std::sort(frequencies.begin(), frequencies.end());
  frequencies.erase(std::unique(frequencies.begin(), frequencies.end()), frequencies.end());

  std::vector<std::pair<double, double>> waiting;
  for (std::size_t i = 1; i < frequencies.size(); ++i) waiting.emplace_back(frequencies[i - 1], frequencies[i]);
  while (!waiting.empty() && frequencies.size() < most_frequencies) {
    const double low = waiting.back().first;
    const double high = waiting.back().second;
    waiting.pop_back();
    if (high / low - 1.0 < least_ratio) continue;
    const double middle = std::sqrt(low * high);
    const bool any = std::any_of(responses.begin(), responses.end(),
                                 [&](const DelayedResponse& response) { return bends(response, low, middle, high); });
    if (!any) continue;
    frequencies.push_back(middle);
    waiting.emplace_back(low, middle);
    waiting.emplace_back(middle, high);
  }
  // At the pole of an undamped mode there is no value, at an undamped zero no decibel.
  std::erase_if(frequencies, [&](double frequency) {
    return std::any_of(responses.begin(), responses.end(), [&](const DelayedResponse& response) {
      return !std::isfinite(decibels(response.value(frequency)));
    });
  });
  std::sort(frequencies.begin(), frequencies.end());
  return frequencies;
}

std::vector<BodePoint> bode_points(const DelayedResponse& response, std::span<const double> frequencies) {
  std::vector<std::complex<double>> values;
  values.reserve(frequencies.size());
  for (const double frequency : frequencies) values.push_back(response.value(frequency));

  std::vector<BodePoint> points;
  points.reserve(values.size());
  double phase = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 0) {
      phase = std::arg(values[0]) * degrees_per_radian;
      if (phase > 90.0) phase -= 360.0;  // a position lags its force
    } else {
      double step = turn(values[i - 1], values[i]);
      // Half a turn that halving could not part is an undamped mode (the phase falls) or zero (it rises).
      if (std::abs(step) > 179.9) {
        const double outer = decibels(values[i < 2 ? 0 : i - 2]) + decibels(values[std::min(i + 1, values.size() - 1)]);
        const double inner = decibels(values[i - 1]) + decibels(values[i]);
        step = inner > outer ? -std::abs(step) : std::abs(step);
      }
      phase += step;
    }
    points.push_back(
        {frequencies[i], decibels(values[i]), phase - frequencies[i] * response.delay * degrees_per_radian});
  }
  return points;
}

}  // namespace zwidth
