#include "identification/response_friction.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include "signal/fourier.hpp"
#include "signal/window_function.hpp"
#include "zwidth/signal/window.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t least_examined_samples = 512;
constexpr std::size_t most_examined_samples = std::size_t{1} << 17U;
constexpr std::size_t fewest_points = 8;
constexpr std::size_t reach = 12;  // lines to either side

using Signal = std::vector<double>;
using Lines = std::vector<std::complex<double>>;

Lines windowed_spectrum(std::span<const double> signal) {
  const Signal window = window_function(Window::hann, signal.size());
  Signal product(signal.begin(), signal.end());
  for (std::size_t i = 0; i < product.size(); ++i) product[i] *= window[i];
  return spectrum(product);
}

/// The response on the lines of a record, between its points; 0 outside.
Lines interpolated(const FrequencyResponse& response, std::size_t count, double step) {
  Lines lines(count, 0.0);
  const std::vector<ResponsePoint>& points = response.points;
  std::size_t above = 1;
  for (std::size_t k = 1; k < count; ++k) {
    const double frequency = step * static_cast<double>(k);
    while (above + 1 < points.size() && points[above].frequency < frequency) ++above;
    const ResponsePoint& low = points[above - 1];
    const ResponsePoint& high = points[above];
    if (frequency < low.frequency || frequency > high.frequency) continue;
    const double share = (frequency - low.frequency) / (high.frequency - low.frequency);
    lines[k] = low.value + share * (high.value - low.value);
  }
  return lines;
}

/// The velocity of the motion G F, per sample.
Signal velocity_of(const Lines& response, std::span<const double> force) {
  const std::size_t n = force.size();
  const Lines lines = spectrum(force);
  Lines all(n, 0.0);
  for (std::size_t k = 1; 2 * k < n; ++k) {
    all[k] = std::complex(0.0, 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n)) *
             response[k] * lines[k];
    all[n - k] = std::conj(all[k]);
  }
  Lines moved(n);
  FourierTransform(n).inverse(all, moved);
  Signal velocity(n);
  std::ranges::transform(moved, velocity.begin(), [](const std::complex<double>& value) { return value.real(); });
  return velocity;
}

/// Less what is proportional to the force on the lines around each.
Lines beside_force(const Lines& lines, const Lines& force) {
  Lines left = lines;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::size_t begin = k - std::min(k, reach);
    const std::size_t end = std::min(lines.size(), k + reach + 1);
    std::complex<double> shared = 0.0;
    double power = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      shared += lines[i] * std::conj(force[i]);
      power += std::norm(force[i]);
    }
    if (power > 0.0) left[k] -= shared / power * force[k];
  }
  return left;
}

/// Mean squares of the lines around each.
Signal powers_around(const Lines& lines) {
  Signal sums(lines.size() + 1, 0.0);
  for (std::size_t k = 0; k < lines.size(); ++k) sums[k + 1] = sums[k] + std::norm(lines[k]);
  const double least = 1e-12 * sums.back() / static_cast<double>(lines.size());
  Signal powers(lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::size_t begin = k - std::min(k, reach);
    const std::size_t end = std::min(lines.size(), k + reach + 1);
    powers[k] = (sums[end] - sums[begin]) / static_cast<double>(end - begin) + least;
  }
  return powers;
}

}  // namespace

std::optional<FrictionBesideResponse> find_friction_beside(const FrequencyResponse& response,
                                                           std::span<const double> force,
                                                           std::span<const double> position) {
  const std::size_t n = std::min(force.size(), most_examined_samples);
  if (n < least_examined_samples || response.points.size() < fewest_points || !response.sampling_period) return std::nullopt;
  force = force.first(n);
  const double period = *response.sampling_period;
  const Lines plant = interpolated(response, n / 2 + 1, 2.0 * std::numbers::pi / (period * static_cast<double>(n)));
  const Signal velocity = velocity_of(plant, force);
  Signal sign(n);
  double speed = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    sign[i] = velocity[i] > 0.0 ? 1.0 : velocity[i] < 0.0 ? -1.0 : 0.0;
    speed += std::abs(velocity[i]);
    square += velocity[i] * velocity[i];
  }
  if (!(square > 0.0)) return std::nullopt;

  const Lines force_lines = windowed_spectrum(force);
  Lines target = windowed_spectrum(position.first(n));
  for (std::size_t k = 0; k < target.size(); ++k) target[k] -= plant[k] * force_lines[k];
  target = beside_force(target, force_lines);
  Lines effect = beside_force(windowed_spectrum(sign), force_lines);
  for (std::size_t k = 0; k < effect.size(); ++k) effect[k] *= plant[k];

  std::complex<double> c = 0.0;
  double weight = 0.0;
  Lines left = target;
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    const Signal powers = powers_around(left);
    std::complex<double> sum = 0.0;
    weight = 0.0;
    for (std::size_t k = 0; k < target.size(); ++k) {
      if (plant[k] == 0.0) continue;
      sum += target[k] * std::conj(effect[k]) / powers[k];
      weight += std::norm(effect[k]) / powers[k];
    }
    if (!(weight > 0.0)) return std::nullopt;
    c = sum / weight;
    for (std::size_t k = 0; k < target.size(); ++k) left[k] = target[k] - c * effect[k];
  }
  // A Hann window makes neighbouring lines share: 1.94 times the variance of independent ones.
  constexpr double shared = 1.94;
  FrictionBesideResponse found;
  found.evidence = 2.0 * std::norm(c) * weight / shared;
  found.equivalent_damping = std::abs(c) * speed / square * period;
  return found;
}

}  // namespace zwidth::internal
