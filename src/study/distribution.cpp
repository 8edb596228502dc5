#include "zwidth/study/distribution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "require_valid.hpp"

namespace zwidth {
namespace {

using Kind = Distribution::Kind;

bool has_centre(Kind kind) { return kind == Kind::normal || kind == Kind::lognormal || kind == Kind::triangular; }
bool has_deviation(Kind kind) { return kind == Kind::normal || kind == Kind::lognormal; }

std::optional<OptionProblem> find_discrete_problem(const Distribution& distribution) {
  const std::vector<double>& values = distribution.values;
  const std::vector<double>& weights = distribution.weights;
  if (values.empty()) return OptionProblem{"values", "is empty", "one value at least"};
  if (weights.size() != values.size()) {
    return OptionProblem{"weights", fmt::format("has length {}", weights.size()),
                         fmt::format("must have one of each value: {}", values.size())};
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) return OptionProblem{"values", fmt::format("has {}", values[i]), "must be finite"};
    if (i > 0 && !(values[i] > values[i - 1])) {
      return OptionProblem{"values", fmt::format("has {} after {}", values[i], values[i - 1]), "each once, rising"};
    }
    if (!(weights[i] > 0.0)) return OptionProblem{"weights", fmt::format("has {}", weights[i]), "must be > 0"};
    sum += weights[i];
  }
  if (!std::isfinite(sum)) return OptionProblem{"weights", "has no finite sum", "must be finite"};
  return std::nullopt;
}

double standard_score_of(const Distribution& distribution, double x) {
  const bool is_log = distribution.kind == Kind::lognormal;
  if (is_log && x <= 0.0) return -std::numeric_limits<double>::infinity();
  return (is_log ? std::log(x / distribution.centre) : x - distribution.centre) / distribution.deviation;
}

}  // namespace

std::optional<OptionProblem> find_problem(const Distribution& distribution) {
  const Kind kind = distribution.kind;
  if (kind == Kind::discrete) return find_discrete_problem(distribution);
  const auto is = [](double value) { return fmt::format("is {}", value); };
  if (has_centre(kind) &&
      (!std::isfinite(distribution.centre) || (kind == Kind::lognormal && distribution.centre <= 0))) {
    return OptionProblem{"centre", is(distribution.centre),
                         kind == Kind::lognormal ? "must be finite and > 0" : "must be finite"};
  }
  if (has_deviation(kind) && !(distribution.deviation > 0.0 && std::isfinite(distribution.deviation))) {
    return OptionProblem{"deviation", is(distribution.deviation), "must be finite and > 0"};
  }
  if (!has_deviation(kind) && !(std::isfinite(distribution.lower) && std::isfinite(distribution.upper))) {
    return OptionProblem{std::isfinite(distribution.lower) ? "upper" : "lower", "is not finite", "must be finite"};
  }
  if (std::isnan(distribution.lower)) return OptionProblem{"lower", "is nan", "must be a number"};
  if (std::isnan(distribution.upper)) return OptionProblem{"upper", "is nan", "must be a number"};
  if (!(distribution.lower < distribution.upper)) {
    return OptionProblem{"upper", is(distribution.upper),
                         fmt::format("must be above the lower end, {}", distribution.lower)};
  }
  if (kind == Kind::triangular &&
      !(distribution.lower <= distribution.centre && distribution.centre <= distribution.upper)) {
    return OptionProblem{"centre", is(distribution.centre),
                         fmt::format("must be from {} to {}", distribution.lower, distribution.upper)};
  }
  if (has_deviation(kind)) {
    const double from = standard_score_of(distribution, distribution.lower);
    const double to = standard_score_of(distribution, distribution.upper);
    constexpr double farthest = 8.0;  // standard deviations: what is left of the normal would be rounding
    if (from > farthest) return OptionProblem{"lower", is(distribution.lower), "must leave a part of the distribution"};
    if (to < -farthest) return OptionProblem{"upper", is(distribution.upper), "must leave a part of the distribution"};
  }
  return std::nullopt;
}

double standard_normal_probability(double z) { return 0.5 * boost::math::erfc(-z / std::numbers::sqrt2); }

double standard_normal_score(double u) { return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * u); }

QuantileFunction::QuantileFunction(Distribution distribution) : distribution_(std::move(distribution)) {
  internal::require_valid(find_problem(distribution_));
  if (has_deviation(distribution_.kind)) {
    below_ = standard_normal_probability(standard_score_of(distribution_, distribution_.lower));
    above_ = standard_normal_probability(-standard_score_of(distribution_, distribution_.upper));
  }
  double sum = 0.0;
  for (const double weight : distribution_.weights) cumulative_.push_back(sum += weight);
}

double QuantileFunction::cut(double score) const {
  const double x = distribution_.kind == Kind::lognormal
                       ? distribution_.centre * std::exp(distribution_.deviation * score)
                       : distribution_.centre + distribution_.deviation * score;
  return std::clamp(x, distribution_.lower, distribution_.upper);
}

double QuantileFunction::operator()(double u) const {
  u = std::clamp(u, least_uniform, 1.0 - least_uniform);
  const double lower = distribution_.lower;
  const double upper = distribution_.upper;
  switch (distribution_.kind) {
    case Kind::normal:
    case Kind::lognormal: {
      // From the nearer tail, so that no digit is lost in 1 - p.
      const double left = below_ + u * (1.0 - below_ - above_);
      const double right = above_ + (1.0 - u) * (1.0 - below_ - above_);
      const double tail = std::max(std::min(left, right), std::numeric_limits<double>::min());
      return cut(left <= right ? standard_normal_score(tail) : -standard_normal_score(tail));
    }
    case Kind::uniform:
      return std::clamp(lower + u * (upper - lower), lower, upper);
    case Kind::triangular: {
      const double rising = distribution_.centre - lower;
      const double whole = upper - lower;
      if (u * whole < rising) return lower + std::sqrt(u * whole * rising);
      return upper - std::sqrt((1.0 - u) * whole * (upper - distribution_.centre));
    }
    case Kind::discrete:
      break;
  }
  const auto found = std::ranges::lower_bound(cumulative_, u * cumulative_.back());
  const auto place = static_cast<std::size_t>(found - cumulative_.begin());
  return distribution_.values[std::min(place, cumulative_.size() - 1)];
}

double QuantileFunction::at_score(double z) const {
  static const double farthest = -standard_normal_score(least_uniform);
  const double score = std::clamp(z, -farthest, farthest);
  if (has_deviation(distribution_.kind) && below_ == 0.0 && above_ == 0.0) return cut(score);
  return (*this)(standard_normal_probability(score));
}

bool QuantileFunction::bounded() const {
  return std::isfinite(distribution_.upper - distribution_.lower) || distribution_.kind == Kind::discrete;
}

}  // namespace zwidth
