#pragma once

// Where along an angle's logarithm x the least gain is that a disc leaves, beside what is known of it at points.

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "stability/users/disc_stiffness.hpp"

namespace zwidth::internal {

// How far from leaving a gain, relative; not positive where one is left.
inline double openness(const GainCondition& condition) {
  const double product = condition.quadratic * condition.constant;
  const double square = condition.half * condition.half;
  return square + std::abs(product) > 0.0 ? (product - square) / (square + std::abs(product)) : 0.0;
}

inline double real_gain(const GainCondition& condition) {
  return least_root(condition.constant, condition.half, condition.quadratic);
}

template <typename Function>
std::pair<double, double> minimum(double first, double last, int bits, const Function& function) {
  std::uintmax_t most = 60;
  return boost::math::tools::brent_find_minima(
      [&](double x) {
        const double value = function(x);
        return std::isfinite(value) ? value : std::numeric_limits<double>::max();
      },
      first, last, bits, most);
}

struct Looked {
  double gain = std::numeric_limits<double>::infinity();
  double x = 0.0;
};

// The least gain that is left beside `inside`, which leaves one. Where a gain is left may end beside it, and the least lie there.
template <typename ConditionAt>
Looked least_beside(double before, double inside, double after, int bits, const ConditionAt& condition_at) {
  Looked least;
  const auto gain = [&](double x) {
    const double left = real_gain(condition_at(x));
    if (left < least.gain) least = {left, x};
    return left;
  };
  if (!std::isfinite(gain(inside))) return least;
  const auto end = [&](double outside) {
    if (std::isfinite(gain(outside))) return outside;
    double within = inside;
    for (int i = 0; i < bits; ++i) {
      const double middle = 0.5 * (within + outside);
      (std::isfinite(gain(middle)) ? within : outside) = middle;
    }
    return within;
  };
  const double first = end(before);
  minimum(first, end(after), bits, gain);
  return least;
}

// The least gain of all that is looked at on the way to where `function` of the condition is least.
template <typename ConditionAt, typename Function>
Looked least_towards(double before, double after, int bits, const ConditionAt& condition_at, const Function& function) {
  Looked least;
  minimum(before, after, bits, [&](double x) {
    const GainCondition at = condition_at(x);
    if (const double gain = real_gain(at); gain < least.gain) least = {gain, x};
    return function(at);
  });
  return least;
}

// Where the least gain is that at the low end `x`: as w -> 0 a gain changes by the square of the angle.
template <typename Least, typename GainAt>
Least followed_to_rest(Least least, double x, const GainAt& gain_at) {
  if (!least.is_at_low_end || !(least.gain > 0.0)) return least;
  const double rise = gain_at(x + std::log(2.0)) - gain_at(x);
  if (std::isfinite(rise)) least.gain = std::max(least.gain - rise / 3.0, 0.0);
  return least;
}

}  // namespace zwidth::internal
