#include "identification/response/pooled_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "signal/median.hpp"

namespace zwidth::internal {
namespace {

/// What a record says about a line.
struct Share {
  const FrequencyResponse* record = nullptr;
  const ResponsePoint* point = nullptr;

  [[nodiscard]] double freedom() const { return std::max(record->averages - 1.0, 0.0); }
  [[nodiscard]] double weight() const { return record->averages * point->force * point->force; }
};
using PooledLine = std::vector<Share>;

/// Of a rigid body under a force that is held for T, -1/(m w^2) as it is sampled, times m:
///
///     (T^2/2) (z + 1)/(z - 1)^2 = -(T^2/4) cos(x) e^{-jx} / sin(x)^2,  x = w T/2
std::complex<double> sampled_rigid_body(double frequency, double period) {
  const double x = 0.5 * frequency * period;
  return -0.25 * period * period * std::cos(x) * std::polar(1.0, -x) / (std::sin(x) * std::sin(x));
}

/// By which lines may differ that are one: a small part of the least spacing of a record's lines.
double tolerance_of(std::span<const FrequencyResponse> measured) {
  constexpr double small = 0.02;
  double spacing = std::numeric_limits<double>::infinity();
  for (const FrequencyResponse& record : measured) {
    for (std::size_t i = 1; i < record.points.size(); ++i) {
      spacing = std::min(spacing, record.points[i].frequency - record.points[i - 1].frequency);
    }
  }
  return std::isfinite(spacing) ? small * spacing : 0.0;
}

/// The response as if the force were held for the first one's period. By a rigid body's ratio, which is exact to what the
/// other bodies do to the images above half the rate. All lines err alike by that, so that it counts as if one had the
/// error of all; and where it is more than a small part of the noise, the first one's own line is enough.
FrequencyResponse held_as(const FrequencyResponse& first, FrequencyResponse response) {
  if (!first.sampling_period || !response.sampling_period || *response.sampling_period == *first.sampling_period) {
    return response;
  }
  const double period = *first.sampling_period;
  const double own = *response.sampling_period;
  constexpr double most = 0.9;  // of half the rate
  std::erase_if(response.points, [&](const ResponsePoint& point) {
    return point.frequency * std::max(own, period) > most * std::numbers::pi;
  });
  const double close = tolerance_of(std::array{first, response});
  const auto is_of_first = [&](double frequency) {
    return std::ranges::any_of(first.points, [&](const ResponsePoint& point) {
      return std::abs(point.frequency - frequency) <= std::max(close, 1e-9 * frequency);
    });
  };
  const auto open_share = [&](double frequency) {
    const auto images = [&](double each) { return std::pow(0.5 * frequency * each, 4) / 15.0; };
    return images(own) - images(period);
  };
  std::erase_if(response.points, [&](const ResponsePoint& point) {
    constexpr double small = 0.1;  // deviations
    const double open = std::abs(open_share(point.frequency)) * std::abs(point.value);
    return open > small * std::sqrt(point.variance) && is_of_first(point.frequency);
  });
  const auto lines = static_cast<double>(response.points.size());
  for (ResponsePoint& point : response.points) {
    const std::complex<double> factor =
        sampled_rigid_body(point.frequency, period) / sampled_rigid_body(point.frequency, own);
    const double open = open_share(point.frequency);
    point.value *= factor;
    point.variance = std::norm(factor) * point.variance + lines * open * open * std::norm(point.value);
  }
  response.sampling_period = period;
  return response;
}

/// The shares of each line, by rising frequency.
std::vector<PooledLine> lines_of(std::span<const FrequencyResponse> measured) {
  constexpr double rounding = 1e-9;
  const double close = tolerance_of(measured);
  constexpr double between_tones = 1e-3;  // of a single sine whose frequency is measured too
  std::vector<Share> shares;
  for (const FrequencyResponse& record : measured) {
    for (const ResponsePoint& point : record.points) shares.push_back({&record, &point});
  }
  std::ranges::stable_sort(shares, {}, [](const Share& share) { return share.point->frequency; });
  const auto is_tone = [](const Share& share) { return share.record->points.size() == 1; };
  std::vector<PooledLine> lines;
  for (const Share& share : shares) {
    if (!lines.empty()) {
      const Share& first = lines.back().front();
      const double relative = is_tone(first) && is_tone(share) ? between_tones : rounding;
      const double tolerance = std::max(close, relative * first.point->frequency);
      if (share.point->frequency <= first.point->frequency + tolerance) {
        lines.back().push_back(share);
        continue;
      }
    }
    lines.push_back({share});
  }
  return lines;
}

struct PooledPoint {
  ResponsePoint point;
  double freedom = 0.0;
  double between = 0.0;  ///< variance of the value that the shares' differences show
};

PooledPoint pooled(const PooledLine& line) {
  PooledPoint result{*line.front().point, line.front().freedom(), 0.0};
  if (line.size() == 1) return result;
  double weights = 0.0;
  double averages = 0.0;
  double force = 0.0;
  result.point.value = 0.0;
  result.point.frequency = 0.0;
  for (const Share& share : line) {
    weights += share.weight();
    averages += share.record->averages;
    force += share.weight();
  }
  double variance = 0.0;
  double of_variance = 0.0;  // at equal noise
  for (const Share& share : line) {
    const double part = share.weight() / weights;
    result.point.value += part * share.point->value;
    result.point.frequency += part * share.point->frequency;
    variance += part * part * share.point->variance;
    of_variance += part * part / share.freedom();
  }
  for (const Share& share : line) {
    const double part = share.weight() / weights;
    result.between += part * std::norm(share.point->value - result.point.value) / static_cast<double>(line.size() - 1);
  }
  result.freedom = 1.0 / of_variance;
  result.point.variance = variance;
  result.point.force = std::sqrt(force / averages);
  return result;
}

/// How much less likely than by noise alone the difference of two shares is: -log P, of mean and variance 1.
double surprise(const Share& a, const Share& b) {
  const double m = std::min(a.freedom(), b.freedom());
  const double noise = a.point->variance + b.point->variance;
  const double ratio = std::norm(a.point->value - b.point->value) / std::max(noise, 1e-300);
  return m * std::log1p(ratio / m);  // P(F > x) = (1 + x / m)^-m for 2 and 2 m degrees of freedom
}

/// Compares, line by line, the record with the least and with the greatest force.
std::optional<AmplitudeDependence> compare(const std::vector<PooledLine>& lines, double correlation) {
  constexpr double significant = 5.0;  // standard deviations of the sum of surprises
  constexpr double a_line_says = 4.6;  // 1 %
  constexpr double notable = 0.005;
  double sum = 0.0;
  double count = 0.0;
  double louder = 0.0;
  std::vector<double> differences;
  std::vector<double> ratios;
  for (const PooledLine& line : lines) {
    const auto [weakest, strongest] =
        std::ranges::minmax_element(line, {}, [](const Share& share) { return share.point->force; });
    if (weakest == strongest || weakest->freedom() == 0.0 || strongest->freedom() == 0.0) continue;
    const double says = surprise(*weakest, *strongest);
    sum += says;
    count += 1.0;
    ratios.push_back(strongest->point->force / weakest->point->force);
    if (says < a_line_says) continue;
    const double size = std::abs(strongest->point->value);
    differences.push_back(std::abs(strongest->point->value - weakest->point->value) / size);
    louder += size > std::abs(weakest->point->value) ? 1.0 : -1.0;
  }
  if (differences.empty() || sum - count < significant * std::sqrt(count * correlation)) return std::nullopt;
  AmplitudeDependence found;
  found.difference = median(differences);
  found.force_ratio = median(ratios);
  found.lines = differences.size();
  found.grows_with_force = louder > 0.0;
  if (found.difference < notable) return std::nullopt;
  return found;
}

}  // namespace

PooledResponse pooled_response(std::span<const FrequencyResponse> own) {
  std::vector<FrequencyResponse> measured;
  for (const FrequencyResponse& each : own) measured.push_back(held_as(own.front(), each));
  const std::vector<PooledLine> lines = lines_of(measured);
  PooledResponse result;
  FrequencyResponse& response = result.response;
  response.sampling_period = measured.front().sampling_period;
  for (const FrequencyResponse& record : measured) {
    response.line_correlation = std::max(response.line_correlation, record.line_correlation);
  }
  result.dependence = compare(lines, response.line_correlation);
  double freedom = std::numeric_limits<double>::infinity();
  for (const PooledLine& line : lines) {
    PooledPoint next = pooled(line);
    freedom = std::min(freedom, next.freedom);
    if (result.dependence) next.point.variance = std::max(next.point.variance, next.between);
    const double noise = (1.0 + next.freedom) * next.point.variance;
    next.point.coherence = std::norm(next.point.value) / (std::norm(next.point.value) + noise);
    response.points.push_back(next.point);
  }
  response.averages = 1.0 + freedom;
  return result;
}

}  // namespace zwidth::internal
