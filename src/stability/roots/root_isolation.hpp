#pragma once

// All roots on the upper unit circle of a function given by value and by first-order Taylor models on intervals, by
// subdivision: no root can hide between points of a grid. Where double precision cannot tell the function from zero the
// same is done in double-double. See docs/completeness.md.

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <type_traits>
#include <vector>

#include "stability/loop/bounded_jet.hpp"
#include "stability/loop/plant_fraction.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {

struct CircleRoot {
  double angle = 0.0;
  // Sign change of f: +1 from negative to positive, -1 the other way; 0: f touches zero, to rounding, without a change.
  int direction = 0;
};

namespace root_isolation {

// An interval this narrow, relative to its end, is not divided further.
inline constexpr double narrowest = 1e-14;
inline constexpr std::size_t max_intervals_per_piece = 100000;
// Where many poles crowd, products of their terms prove nothing of intervals that are not narrower than any of use: a
// stretch that has taken so many is asked of the sum of terms, as is where f is zero to rounding.
inline constexpr std::size_t max_intervals_per_stretch = 60000;
inline constexpr double stretch = 1.0 / 64.0;  // of its end
inline constexpr std::uintmax_t max_polish_steps = 200;
// Beyond this x an angle in double says less of x than x itself.
inline constexpr double nearest_pi = 3.999;

struct Interval {
  double begin;
  double end;
  bool extended;  // double precision did not decide
};

enum class Content { none, at_most_one, undecided, zero_to_rounding };

template <typename Scalar>
Content content(const BoundedJet<Scalar>& f) {
  const double noise = rounding_of_jets<Scalar> * f.weight;
  const double value = std::abs(leading(f.value));
  const double slope = std::abs(leading(f.slope));
  if (value > slope + 0.5 * f.bend + noise) return Content::none;
  if (slope > f.bend + noise) return Content::at_most_one;
  return f.size() <= 4.0 * noise ? Content::zero_to_rounding : Content::undecided;
}

// Sign of f at x, the same whoever asks: neighbours agree about their common end.
template <typename Function>
bool is_positive(const Function& f, double x) {
  const BoundedJet<double> point = f.template model<double>(x, x);
  if (std::abs(point.value) > rounding_of_jets<double> * point.weight) return point.value > 0.0;
  return leading(f.template model<Extended>(x, x).value) > 0.0;
}

// Angle of the one root in an interval of x with a sign change.
template <typename Function>
double polish(const Function& f, const Interval& interval) {
  std::uintmax_t steps = max_polish_steps;
  const auto close_enough = [](double a, double b) {
    return std::abs(b - a) <= 2.0 * std::numeric_limits<double>::epsilon() * std::abs(b);
  };
  const double end = std::min(interval.end, nearest_pi);
  if (!interval.extended && interval.begin < end) {
    const double first = angle_of(interval.begin);
    const double last = angle_of(end);
    const double at_first = f.value(first);
    const double at_last = f.value(last);
    if ((at_first > 0.0) != (at_last > 0.0) && at_first != 0.0 && at_last != 0.0) {
      const auto [low, high] = boost::math::tools::toms748_solve([&f](double angle) { return f.value(angle); }, first,
                                                                 last, at_first, at_last, close_enough, steps);
      return 0.5 * (low + high);
    }
  }
  const auto sign = [&f](double x) { return leading(f.template model<Extended>(x, x).value); };
  const double at_begin = sign(interval.begin);
  const double at_end = sign(interval.end);
  if (at_begin == 0.0 || at_end == 0.0 || (at_begin > 0.0) == (at_end > 0.0)) {
    return angle_of(std::abs(at_begin) < std::abs(at_end) ? interval.begin : interval.end);
  }
  const auto [low, high] =
      boost::math::tools::toms748_solve(sign, interval.begin, interval.end, at_begin, at_end, close_enough, steps);
  return angle_of(0.5 * (low + high));
}

// The roots in a run of intervals where the function is zero to rounding, from its sum of terms, in angles. Asked
// evenly and ever closer to each pole. Where the value is rounding while what it is a part of is not, f touches zero;
// where both are, the gain is beyond all digits.
struct RootsByTerms {
  std::vector<CircleRoot> roots;
  bool is_certain = true;  // the sign was beyond rounding wherever it was asked
  // Signs at the first and the last angle where it was; 0: nowhere.
  int first_sign = 0;
  int last_sign = 0;
  double last_certain = 0.0;
};

template <typename Function>
RootsByTerms roots_by_terms(const Function& f, double begin, double end) {
  const std::vector<double> poles = f.pole_angles();
  const int even_points = 64 + 16 * static_cast<int>(poles.size());  // a crossover or two per pole
  constexpr int halvings = 44;
  const double width = end - begin;
  std::vector<double> angles;
  for (int i = 0; i <= even_points; ++i) angles.push_back(begin + width * i / even_points);
  for (const double pole : poles) {
    double distance = width;
    for (int i = 0; i < halvings; ++i, distance *= 0.5) {
      for (const double angle : {pole - distance, pole + distance}) {
        if (angle > begin && angle < end) angles.push_back(angle);
      }
    }
  }
  std::sort(angles.begin(), angles.end());
  RootsByTerms found;
  constexpr double resolved = 1e3;  // times the noise
  double last_angle = begin;
  double last = 0.0;    // the last value whose sign is certain
  double touch = -1.0;  // an angle since then at which f may touch zero
  for (const double angle : angles) {
    const auto [value, noise, size, cancellation] = f.by_terms(angle);
    if (!(std::abs(value) > noise)) {
      found.is_certain = false;
      if (size > resolved * noise) touch = angle;
      continue;
    }
    if (last != 0.0 && (value > 0.0) != (last > 0.0)) {
      std::uintmax_t steps = max_polish_steps;
      const auto close_enough = [](double a, double b) {
        return std::abs(b - a) <= 2.0 * std::numeric_limits<double>::epsilon() * std::abs(b);
      };
      const auto [low, high] = boost::math::tools::toms748_solve([&f](double at) { return f.by_terms(at).value; },
                                                                 last_angle, angle, last, value, close_enough, steps);
      found.roots.push_back({0.5 * (low + high), value > 0.0 ? 1 : -1});
    } else if (last != 0.0 && touch >= 0.0) {
      found.roots.push_back({touch, 0});
    }
    touch = -1.0;
    if (last == 0.0) found.first_sign = value > 0.0 ? 1 : -1;
    last_angle = angle;
    last = value;
  }
  if (last != 0.0) found.last_sign = last > 0.0 ? 1 : -1;
  found.last_certain = last_angle;
  return found;
}

// Where to divide an interval of x: by ratio while it spans orders of magnitude, else in half.
inline double division(double begin, double end) {
  if (begin == 0.0) return end / 32.0;
  return end > 4.0 * begin ? std::sqrt(begin * end) : 0.5 * (begin + end);
}

}  // namespace root_isolation

// Leaves nothing out.
struct WholeCircle {
  [[nodiscard]] static bool leaves_out(double, double) { return false; }
};

// Function: double value(double angle) const; BoundedJet<Scalar> model<Scalar>(double begin, double end) const on an
// interval of x = |z - 1|², in double and Extended. `pieces` intervals, equal in angle, to start with: about one per
// half turn of the function's fastest oscillation. Region: what of the circle is of no interest, asked before anything
// else. Throws Error (did_not_converge) past a cap on the number of intervals.
template <typename Function, typename Region = WholeCircle>
std::vector<CircleRoot> roots_on_circle(const Function& f, std::size_t pieces, Region&& region = {}) {
  using namespace root_isolation;
  constexpr bool is_whole = std::is_same_v<std::remove_cvref_t<Region>, WholeCircle>;
  std::vector<CircleRoot> roots;
  std::vector<Interval> stack;
  stack.reserve(64 + (is_whole ? pieces : 0));
  if constexpr (is_whole) {
    double right = 4.0;
    for (std::size_t i = pieces; i-- > 0;) {  // leftmost on top
      const double half_sine = std::sin(0.5 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(pieces));
      const double left = 4.0 * half_sine * half_sine;
      stack.push_back({left, right, false});
      right = left;
    }
  } else {
    stack.push_back({0.0, 4.0, false});
  }
  const double widest = 1.5 * std::numbers::pi / static_cast<double>(pieces);  // angle, that f is asked on
  std::size_t intervals_left = max_intervals_per_piece * pieces;
  double stretch_end = 0.0;
  std::size_t intervals_of_stretch = 0;
  double zero_begin = -1.0;  // a run of neighbouring intervals in which f is zero to rounding
  double zero_end = -1.0;
  const auto end_of_run = [&] {
    if (zero_begin < 0.0) return;
    const bool before = is_positive(f, zero_begin);
    const bool after = is_positive(f, zero_end);
    if constexpr (requires { f.by_terms(0.0); }) {
      const RootsByTerms inside = roots_by_terms(f, angle_of(zero_begin), angle_of(zero_end));
      if (inside.last_sign != 0 && (inside.first_sign > 0) == before && (inside.is_certain || !inside.roots.empty())) {
        roots.insert(roots.end(), inside.roots.begin(), inside.roots.end());
        // What comes of the run must agree with what goes in: the rest lies where nothing is certain.
        if ((inside.last_sign > 0) != after) {
          roots.push_back({0.5 * (inside.last_certain + angle_of(zero_end)), after ? 1 : -1});
        }
        zero_begin = -1.0;
        return;
      }
    }
    roots.push_back({angle_of(0.5 * (zero_begin + zero_end)), before == after ? 0 : after ? 1 : -1});
    zero_begin = -1.0;
  };
  while (!stack.empty()) {
    if (intervals_left-- == 0) throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::crossovers_not_found});
    const Interval interval = stack.back();
    const auto [begin, end, extended] = interval;
    stack.pop_back();
    if (begin >= stretch_end) {
      stretch_end = std::max(begin, root_isolation::narrowest) * (1.0 + stretch);
      intervals_of_stretch = 0;
    }
    ++intervals_of_stretch;
    if constexpr (!is_whole) {
      if (!extended && region.leaves_out(begin, end)) {
        end_of_run();
        continue;
      }
      if (pieces > 1 && angle_of(end) - angle_of(begin) > widest) {
        const double middle = division(begin, end);
        stack.push_back({middle, end, false});
        stack.push_back({begin, middle, false});
        continue;
      }
    }
    Content found =
        extended ? content(f.template model<Extended>(begin, end)) : content(f.template model<double>(begin, end));
    const bool narrow = end - begin <= narrowest * end;
    if (!extended && (found == Content::zero_to_rounding || (narrow && found == Content::undecided))) {
      stack.push_back({begin, end, true});
      continue;
    }
    if (narrow && found == Content::undecided) found = Content::zero_to_rounding;
    if constexpr (requires { f.by_terms(0.0); }) {
      const bool is_exhausted =
          intervals_of_stretch > max_intervals_per_stretch || 4 * intervals_left < max_intervals_per_piece * pieces;
      if (is_exhausted && found == Content::undecided && end - begin <= stretch * end) {
        found = Content::zero_to_rounding;
      }
    }
    if (found == Content::zero_to_rounding) {
      if (zero_begin < 0.0) zero_begin = begin;
      zero_end = end;
      continue;
    }
    if (found == Content::undecided) {
      const double middle = division(begin, end);
      stack.push_back({middle, end, extended});
      stack.push_back({begin, middle, extended});
      continue;
    }
    end_of_run();
    if (found == Content::at_most_one) {
      const bool after = is_positive(f, end);
      if (is_positive(f, begin) != after) roots.push_back({polish(f, interval), after ? 1 : -1});
    }
  }
  end_of_run();
  return roots;
}

}  // namespace zwidth::internal
