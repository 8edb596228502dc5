#include "identification/crossover/band_beginning.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <vector>

#include "zwidth/quantity.hpp"

namespace zwidth::internal {

std::optional<Beginning> beginning_of(std::span<const PhaseLine> lines) {
  constexpr double reach = 1.5;  // times the lowest frequency
  constexpr std::size_t fewest = 4;
  std::vector<double> x;
  std::vector<double> magnitude;
  std::vector<double> phase;
  for (const PhaseLine& line : lines) {
    if (line.frequency > reach * lines.front().frequency && x.size() >= fewest) break;
    if (!line.measured) continue;
    x.push_back(std::log(line.frequency));
    magnitude.push_back(std::log(std::abs(line.value)));
    const double angle = std::arg(line.value);
    phase.push_back(phase.empty() ? angle
                                  : phase.back() + std::remainder(angle - phase.back(), 2.0 * std::numbers::pi));
  }
  if (x.size() < fewest) return std::nullopt;
  const auto slope_of = [&x](const std::vector<double>& y) {
    const double middle = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
    double shared = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      shared += (x[i] - middle) * y[i];
      squares += (x[i] - middle) * (x[i] - middle);
    }
    return shared / squares;
  };
  return Beginning{slope_of(magnitude), slope_of(phase)};
}

std::optional<double> turned_phase(std::span<const PhaseLine> lines) {
  constexpr double steepest = -3.0;
  constexpr double falling = -0.7;
  constexpr double most_turning = 0.5;
  constexpr double right_angle = 0.5 * std::numbers::pi;
  constexpr double off = 1.5 * right_angle;
  const std::optional<Beginning> beginning = beginning_of(lines);
  if (!beginning || beginning->steepness < steepest || beginning->steepness > falling) return std::nullopt;
  if (std::abs(beginning->turning) > most_turning) return std::nullopt;
  const double phase = std::arg(lines.front().value);
  if (std::abs(std::remainder(phase - right_angle * beginning->steepness, 4.0 * right_angle)) < off)
    return std::nullopt;
  return degrees(phase);
}

}  // namespace zwidth::internal
