#include "simulation/steady_part.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulation/straight_line.hpp"

namespace zwidth::internal {
namespace {

constexpr double scatters_allowed = 3.0;

double swing(std::span<const double> position) {
  double sum = 0.0;
  for (const double each : without_line(position)) sum += each * each;
  return std::sqrt(sum / static_cast<double>(position.size()));
}

}  // namespace

SteadyPart steady_part(std::span<const double> position, std::size_t stretch, double tolerance) {
  const std::size_t count = position.size() / stretch;
  const std::size_t start = position.size() - count * stretch;
  std::vector<double> swings;
  for (std::size_t i = 0; i < count; ++i) swings.push_back(swing(position.subspan(start + i * stretch, stretch)));

  const std::size_t in_last_half = count / 2;
  const std::span<const double> last_half = std::span(swings).last(in_last_half);
  const StraightLine line = straight_line(last_half);
  const double mean = line.middle;
  double variance = 0.0;
  for (const double each : without_line(last_half)) variance += each * each / static_cast<double>(in_last_half - 1);
  SteadyPart part;
  part.scatter = std::sqrt(variance) / mean;
  part.trend = line.slope * static_cast<double>(in_last_half - 1) / mean;

  const double allowed = std::max(tolerance, scatters_allowed * part.scatter) * mean;
  std::size_t first = count - in_last_half;
  while (first > 0 && std::abs(swings[first - 1] - mean) <= allowed) --first;
  part.from = first == 0 ? 0 : start + first * stretch;
  return part;
}

}  // namespace zwidth::internal
