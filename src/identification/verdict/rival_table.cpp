#include "identification/verdict/rival_table.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "identification/verdict/confidence.hpp"

namespace zwidth::internal {
namespace {

/// A row with how far it moves the logarithm of the limit.
struct MovingRival {
  RivalEstimate row;
  double moves = 0.0;
};

std::optional<Eigen::Index> place_of_number(const std::vector<Number>& numbers, const std::string& key) {
  const auto found = std::ranges::find(numbers, key, &Number::key);
  if (found == numbers.end()) return std::nullopt;
  return found - numbers.begin();
}

/// Where a rival is none; nothing where its number is a logarithm.
std::optional<double> none_of(const Number& number) {
  if (number.scale == Number::Scale::logarithmic) return std::nullopt;
  return number.scale == Number::Scale::square ? Number::least_square : 0.0;
}

MovingRival estimate_of(const BestNumbers& best, Eigen::Index at) {
  constexpr double as_believed = 0.9;
  constexpr double most_gain = 1e9;
  const Number& number = best.numbers[static_cast<std::size_t>(at)];
  MovingRival made;
  made.row.parameter = number.key;
  made.row.value = number.value(best.x(at));
  const double variance = best.covariance(at, at);
  if (!(variance >= 0.0) || !std::isfinite(variance)) return made;
  const double deviation = std::sqrt(variance);
  if (deviation < as_believed * number.prior_deviation)
    made.row.standard_deviation = number.slope(best.x(at)) * deviation;
  if (const auto none = none_of(number)) {
    const double away = best.x(at) - *none;
    made.row.log_likelihood_gain = away == 0.0 ? 0.0 : std::min(most_gain, 0.5 * away * away / variance);
  }
  const double shared = best.covariance.row(at).dot(best.stiffness_slope);
  const double slope = variance > 0.0 ? shared / variance : 0.0;
  const double down = slope * std::max(-deviations_of_95 * deviation, std::min(0.0, number.lowest() - best.x(at)));
  const double up = slope * deviations_of_95 * deviation;
  if (!std::isfinite(down) || !std::isfinite(up)) return made;
  made.moves = std::abs(up - down);
  const auto cut = [&](double log_shift) {
    const double least = std::min(best.interval.lower, best.stiffness);
    const double most = std::max(best.interval.upper, best.stiffness);
    return std::clamp(best.stiffness * std::exp(log_shift), least, most);
  };
  made.row.stiffness_interval = Interval{cut(std::min(down, up)), cut(std::max(down, up))};
  return made;
}

}  // namespace

std::vector<RivalEstimate> rival_table(const BestNumbers& best, std::span<const AddedRival> rivals) {
  std::vector<MovingRival> rows;
  for (const AddedRival& rival : rivals) {
    for (const std::string& key : rival.keys) {
      const auto at = place_of_number(best.numbers, key);
      if (!at) continue;
      rows.push_back(estimate_of(best, *at));
      rows.back().row.code = rival.code;
      rows.back().row.unit = unit_of(rival.measure, best.motion);
    }
  }
  std::ranges::stable_sort(rows, std::greater{}, &MovingRival::moves);
  std::vector<RivalEstimate> table;
  for (MovingRival& each : rows) table.push_back(std::move(each.row));
  return table;
}

}  // namespace zwidth::internal
