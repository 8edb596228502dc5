#include "identification/initial_fit/response_features.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "signal/median.hpp"

namespace zwidth::internal {
namespace {

double inertance(const ResponsePoint& point) { return std::abs(point.value) * point.frequency * point.frequency; }

double relative_deviation(const ResponsePoint& point) { return std::sqrt(point.variance) / std::abs(point.value); }

/// Median over the first or last few points of what `of` says about each.
template <typename Points, typename Of>
double typical(const Points& points, Of of) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const ResponsePoint& point : points) values.push_back(of(point));
  return median(std::move(values));
}

/// Peaks and dips of w^2 |P| that stand out: the curve turns back by more than the noise explains, and by 3 dB.
void find_extremes(const std::vector<ResponsePoint>& points, ResponseFeatures& features) {
  constexpr double least_turn = 0.35;  // nepers
  constexpr double deviations = 5.0;
  enum class Looking { either, for_peak, for_dip } looking = Looking::either;
  double highest = std::log(inertance(points.front()));
  double lowest = highest;
  double highest_at = points.front().frequency;
  double lowest_at = highest_at;
  for (const ResponsePoint& point : points) {
    const double level = std::log(inertance(point));
    const double turn = std::max(least_turn, deviations * relative_deviation(point));
    if (level > highest) {
      highest = level;
      highest_at = point.frequency;
    }
    if (level < lowest) {
      lowest = level;
      lowest_at = point.frequency;
    }
    const bool fell = level < highest - turn;
    const bool rose = level > lowest + turn;
    if (fell && looking != Looking::for_dip) {
      // Where the curve begins by falling there is no peak, only its start.
      if (highest_at > points.front().frequency) features.resonances.push_back(highest_at);
      looking = Looking::for_dip;
      lowest = level;
      lowest_at = point.frequency;
    } else if (rose && looking != Looking::for_peak) {
      if (lowest_at > points.front().frequency) features.antiresonances.push_back(lowest_at);
      looking = Looking::for_peak;
      highest = level;
      highest_at = point.frequency;
    }
  }
}

/// Without its delay a lightly damped response is real, of either sign; so its square, turned back by twice the right
/// delay, adds up.
double find_delay(const std::vector<ResponsePoint>& points) {
  const double highest = points.back().frequency;
  const double step = std::numbers::pi / (8.0 * highest);
  // Doubled, the phase is open by half as much; and half of that again leaves no neighbour of an alias.
  const double longest = 0.45 * longest_resolved_delay(points);
  constexpr int steps = 400;  // 25 turns of the highest frequency
  double best = 0.0;
  double best_sum = -1.0;
  for (int i = 0; i <= steps; ++i) {
    const double delay = step * i;
    if (delay > longest) break;
    double sum = 0.0;
    for (const ResponsePoint& point : points) {
      sum += std::cos(2.0 * (std::arg(point.value) + point.frequency * delay));
    }
    if (sum > best_sum) {
      best_sum = sum;
      best = delay;
    }
  }
  return best;
}

}  // namespace

double longest_resolved_delay(const std::vector<ResponsePoint>& points) {
  double spacing = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < points.size(); ++i) {
    spacing = std::min(spacing, points[i].frequency - points[i - 1].frequency);
  }
  return std::numbers::pi / spacing;
}

ResponseFeatures response_features(const std::vector<ResponsePoint>& points) {
  ResponseFeatures features;
  find_extremes(points, features);
  const std::size_t few = std::max<std::size_t>(1, points.size() / 20);
  const std::vector<ResponsePoint> first(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(few));
  const std::vector<ResponsePoint> last(points.end() - static_cast<std::ptrdiff_t>(few), points.end());
  const auto inertia = [](const ResponsePoint& point) { return 1.0 / inertance(point); };
  features.inertia_below = typical(first, inertia);
  features.inertia_above = typical(last, inertia);
  features.stiffness_below = typical(first, [](const ResponsePoint& point) { return 1.0 / std::abs(point.value); });
  features.delay = find_delay(points);
  return features;
}

std::vector<ResponsePoint> thinned(const std::vector<ResponsePoint>& points, const ResponseFeatures& features,
                                   std::size_t most) {
  if (points.size() <= most) return points;
  std::set<double> kept(features.resonances.begin(), features.resonances.end());
  kept.insert(features.antiresonances.begin(), features.antiresonances.end());
  const double ratio = std::log(points.back().frequency / points.front().frequency) / static_cast<double>(most - 1);
  for (std::size_t i = 0; i < most; ++i) {
    const double wanted = points.front().frequency * std::exp(ratio * static_cast<double>(i));
    const auto nearest = std::ranges::lower_bound(points, 0.999999 * wanted, {}, &ResponsePoint::frequency);
    kept.insert(nearest == points.end() ? points.back().frequency : nearest->frequency);
  }
  std::vector<ResponsePoint> result;
  for (const ResponsePoint& point : points) {
    if (kept.count(point.frequency) > 0) result.push_back(point);
  }
  return result;
}

}  // namespace zwidth::internal
