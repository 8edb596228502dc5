#include "zwidth/study/distribution.hpp"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "counted.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
namespace {

using Kind = Distribution::Kind;

bool has_centre(Kind kind) { return kind == Kind::normal || kind == Kind::lognormal || kind == Kind::triangular; }
bool has_deviation(Kind kind) { return kind == Kind::normal || kind == Kind::lognormal; }

std::optional<OptionProblem> find_discrete_problem(const Distribution& distribution) {
  const std::vector<double>& values = distribution.values;
  const std::vector<double>& weights = distribution.weights;
  if (values.empty()) return option_problem("values", {.code = ProblemCode::no_values});
  if (weights.size() != values.size()) {
    return option_problem("weights", {.code = ProblemCode::weights_not_one_a_value,
                                      .evidence = {internal::counted("weights", weights.size()),
                                                   internal::counted("values", values.size())}});
  }
  const auto entry_problem = [](const char* member, ProblemCode code, double value) {
    return option_problem(member, {.code = code, .evidence = {{"value", value}, {"entry", 1.0}}});
  };
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) return entry_problem("values", ProblemCode::not_finite, values[i]);
    if (i > 0 && !(values[i] > values[i - 1])) {
      return option_problem("values", {.code = ProblemCode::values_not_rising,
                                       .evidence = {{"value", values[i]}, {"before", values[i - 1]}}});
    }
    if (!(weights[i] > 0.0)) return entry_problem("weights", ProblemCode::not_finite_and_positive, weights[i]);
    sum += weights[i];
  }
  if (!std::isfinite(sum)) return option_problem("weights", {.code = ProblemCode::no_finite_sum});
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
  using enum ProblemCode;
  const auto problem = [](const char* member, ProblemCode code, double value) {
    return option_problem(member, {.code = code, .evidence = {{"value", value}}});
  };
  if (has_centre(kind) &&
      (!std::isfinite(distribution.centre) || (kind == Kind::lognormal && distribution.centre <= 0))) {
    return problem("centre", kind == Kind::lognormal ? not_finite_and_positive : not_finite, distribution.centre);
  }
  if (has_deviation(kind) && !(distribution.deviation > 0.0 && std::isfinite(distribution.deviation))) {
    return problem("deviation", not_finite_and_positive, distribution.deviation);
  }
  if (!has_deviation(kind) && !(std::isfinite(distribution.lower) && std::isfinite(distribution.upper))) {
    return option_problem(std::isfinite(distribution.lower) ? "upper" : "lower", {.code = not_finite});
  }
  if (std::isnan(distribution.lower)) return problem("lower", not_a_number, std::abs(distribution.lower));
  if (std::isnan(distribution.upper)) return problem("upper", not_a_number, std::abs(distribution.upper));
  if (!(distribution.lower < distribution.upper)) {
    return option_problem("upper", {.code = not_above_lower_end,
                                    .evidence = {{"value", distribution.upper}, {"least", distribution.lower}}});
  }
  if (kind == Kind::triangular &&
      !(distribution.lower <= distribution.centre && distribution.centre <= distribution.upper)) {
    return option_problem(
        "centre",
        {.code = not_between,
         .evidence = {{"value", distribution.centre}, {"least", distribution.lower}, {"most", distribution.upper}}});
  }
  if (has_deviation(kind)) {
    const double from = standard_score_of(distribution, distribution.lower);
    const double to = standard_score_of(distribution, distribution.upper);
    constexpr double farthest = 8.0;  // standard deviations: what is left of the normal would be rounding
    if (from > farthest) return problem("lower", no_part_left, distribution.lower);
    if (to < -farthest) return problem("upper", no_part_left, distribution.upper);
  }
  return std::nullopt;
}

double standard_normal_probability(double z) { return 0.5 * boost::math::erfc(-z / std::numbers::sqrt2); }

double standard_normal_score(double u) { return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * u); }

QuantileFunction::QuantileFunction(Distribution distribution) : distribution_(std::move(distribution)) {
  require_valid(find_problem(distribution_));
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
