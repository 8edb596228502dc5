#include "identification/band_beginning.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <vector>

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

}  // namespace zwidth::internal
