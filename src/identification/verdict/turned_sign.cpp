#include "identification/verdict/turned_sign.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "identification/verdict/calibration.hpp"

namespace zwidth::internal {
namespace {

/// Of the logarithms of gain over frequency, by lines within an octave either way; nothing of fewer than 4.
std::optional<double> slope_at(std::span<const ResponsePoint> points, double frequency) {
  constexpr double reach = 2.0;
  constexpr double least_lines = 4.0;
  double weight = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  for (const ResponsePoint& each : points) {
    if (each.frequency < frequency / reach || each.frequency > frequency * reach) continue;
    const double a = std::log(each.frequency / frequency);
    const double b = std::log(std::abs(each.value));
    weight += 1.0;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  const double spread = weight * xx - x * x;
  if (weight < least_lines || !(spread > 0.0)) return std::nullopt;
  return (weight * xy - x * y) / spread;
}

}  // namespace

std::optional<double> agreement_of_sign(const FrequencyResponse& response) {
  const std::span<const ResponsePoint> points = response.points;
  constexpr std::size_t least_lines = 3;
  if (points.size() < least_lines) return std::nullopt;
  const double middle = std::sqrt(points.front().frequency * points.back().frequency);
  double sum = 0.0;
  double weights = 0.0;
  for (const ResponsePoint& each : points) {
    if (each.frequency > middle || !(std::abs(each.value) > 0.0)) continue;
    constexpr double of_rigid_body = -2.0;
    const auto measured = slope_at(points, each.frequency);
    if (!measured) continue;
    const double slope = std::clamp(*measured, of_rigid_body, 0.0);
    sum += each.coherence * std::cos(std::arg(each.value) - 0.5 * std::numbers::pi * slope);
    weights += each.coherence;
  }
  return weights > 0.0 ? std::optional(sum / weights) : std::nullopt;
}

std::optional<Finding> turned_sign(const FrequencyResponse& response) {
  const auto agreement = agreement_of_sign(response);
  if (!agreement || *agreement > Calibration::turned_agreement) return std::nullopt;
  return Finding{.code = FindingCode::motion_against_force,
                 .evidence = {{"agreement", *agreement}, {"threshold", Calibration::turned_agreement}}};
}

}  // namespace zwidth::internal
