#pragma once

// All roots on the upper unit circle of a function given by value and by first-order Taylor models on intervals, by
// subdivision: no root can hide between points of a grid. See docs/completeness.md.

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "stability/bounded_jet.hpp"
#include "stability/plant_fraction.hpp"
#include "zwidth/error.hpp"

namespace zwidth {

struct CircleRoot {
  double angle = 0.0;
  // Sign change of f: +1 from negative to positive, -1 the other way; 0: f touches zero, to rounding, without a change.
  int direction = 0;
};

namespace root_isolation {

// Rounding of f, relative to the sum of magnitudes of its terms (BoundedJet::weight). Evaluation takes a few dozen
// operations per modal term.
inline constexpr double rounding = 256.0 * std::numeric_limits<double>::epsilon();
// An interval this narrow, relative to its end, is not divided further.
inline constexpr double narrowest = 1e-14;
inline constexpr std::size_t max_intervals_per_piece = 100000;
inline constexpr std::uintmax_t max_polish_steps = 100;

template <typename Function>
double polish(const Function& f, double begin, double end, double at_begin, double at_end) {
  if (at_begin == 0.0) return begin;
  if (at_end == 0.0) return end;
  std::uintmax_t steps = max_polish_steps;
  const auto close_enough = [](double a, double b) {
    return std::abs(b - a) <= 2.0 * std::numeric_limits<double>::epsilon() * std::abs(b);
  };
  const auto [low, high] = boost::math::tools::toms748_solve([&f](double angle) { return f.value(angle); }, begin, end,
                                                             at_begin, at_end, close_enough, steps);
  return 0.5 * (low + high);
}

// Where to divide an interval of x: by ratio while it spans orders of magnitude, else in half.
inline double division(double begin, double end) {
  if (begin == 0.0) return end / 256.0;
  return end > 9 * begin ? std::sqrt(begin * end) : 0.5 * (begin + end);
}

}  // namespace root_isolation

// Function: double value(double angle) const; BoundedJet model(double begin, double end) const on an interval of
// x = |z - 1|². `pieces` intervals, equal in angle, to start with: about one per half turn of the function's fastest
// oscillation. Throws Error (did_not_converge) past a cap on the number of intervals.
template <typename Function>
std::vector<CircleRoot> roots_on_circle(const Function& f, std::size_t pieces) {
  using namespace root_isolation;
  struct Interval {
    double begin;
    double end;
  };
  std::vector<CircleRoot> roots;
  std::vector<Interval> stack;
  stack.reserve(64 + pieces);
  double right = 4.0;
  for (std::size_t i = pieces; i-- > 0;) {  // leftmost on top
    const double half_sine = std::sin(0.5 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(pieces));
    const double left = 4.0 * half_sine * half_sine;
    stack.push_back({left, right});
    right = left;
  }
  std::size_t intervals_left = max_intervals_per_piece * pieces;
  double zero_begin = -1.0;  // a run of neighbouring intervals in which f is zero to rounding
  double zero_end = -1.0;
  const auto end_of_run = [&] {
    if (zero_begin < 0.0) return;
    const bool before = f.value(angle_of(zero_begin)) > 0.0;
    const bool after = f.value(angle_of(zero_end)) > 0.0;
    roots.push_back({angle_of(0.5 * (zero_begin + zero_end)), before == after ? 0 : after ? 1 : -1});
    zero_begin = -1.0;
  };
  while (!stack.empty()) {
    if (intervals_left-- == 0) throw Error(ErrorCode::did_not_converge, "the crossovers could not be isolated");
    const auto [begin, end] = stack.back();
    stack.pop_back();
    const BoundedJet model = f.model(begin, end);
    const double noise = rounding * model.weight;
    if (std::abs(model.value) > std::abs(model.slope) + 0.5 * model.bend + noise) {  // no root
      end_of_run();
      continue;
    }
    if (std::abs(model.slope) > model.bend + noise) {  // monotone: at most one root
      end_of_run();
      const double first = angle_of(begin);
      const double last = angle_of(end);
      const double at_first = f.value(first);
      const double at_last = f.value(last);
      if ((at_first > 0.0) != (at_last > 0.0)) {
        roots.push_back({polish(f, first, last, at_first, at_last), at_last > 0.0 ? 1 : -1});
      }
      continue;
    }
    if (model.size() <= 4.0 * noise || end - begin <= narrowest * end) {
      if (zero_begin < 0.0) zero_begin = begin;
      zero_end = end;
      continue;
    }
    const double middle = division(begin, end);
    stack.push_back({middle, end});
    stack.push_back({begin, middle});
  }
  end_of_run();
  return roots;
}

}  // namespace zwidth
