#include "stability/root_isolation.hpp"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

// Rounding of f, relative to the sum of magnitudes of its terms (BoundedJet::weight). Evaluation takes a few dozen
// operations per modal term.
constexpr double rounding = 256.0 * std::numeric_limits<double>::epsilon();
// An interval this narrow, relative to its angle, is not divided further.
constexpr double narrowest = 1e-14;
constexpr std::size_t max_intervals_per_sample = 100000;
constexpr std::uintmax_t max_polish_steps = 100;

struct Interval {
  double begin;
  double end;
};

double polish(const GainLocus& locus, double begin, double end, double phase_begin, double phase_end) {
  if (phase_begin == 0.0) return begin;
  if (phase_end == 0.0) return end;
  std::uintmax_t steps = max_polish_steps;
  const auto close_enough = [](double a, double b) {
    return std::abs(b - a) <= 2.0 * std::numeric_limits<double>::epsilon() * std::abs(b);
  };
  const auto [low, high] = boost::math::tools::toms748_solve([&locus](double angle) { return locus.phase(angle); },
                                                             begin, end, phase_begin, phase_end, close_enough, steps);
  return 0.5 * (low + high);
}

}  // namespace

std::vector<PhaseRoot> phase_roots(const GainLocus& locus) {
  std::vector<PhaseRoot> roots;
  std::vector<Interval> stack;
  stack.reserve(64);
  // Start with about a quarter turn of the delay per interval, leftmost on top.
  const std::size_t pieces = 1 + 2 * locus.delay_samples();
  for (std::size_t i = pieces; i-- > 0;) {
    const double step = std::numbers::pi / static_cast<double>(pieces);
    stack.push_back(
        {static_cast<double>(i) * step, i + 1 == pieces ? std::numbers::pi : static_cast<double>(i + 1) * step});
  }
  const std::size_t max_intervals = max_intervals_per_sample * pieces;
  double undecided_begin = -1.0;  // a run of neighbouring intervals in which f is zero to rounding
  double undecided_end = -1.0;
  const auto close_run = [&] {
    if (undecided_begin < 0.0) return;
    const bool before = locus.phase(undecided_begin) > 0.0;
    const bool after = locus.phase(undecided_end) > 0.0;
    roots.push_back({0.5 * (undecided_begin + undecided_end), before == after ? 0 : after ? 1 : -1});
    undecided_begin = -1.0;
  };
  for (std::size_t count = 0; !stack.empty(); ++count) {
    if (count > max_intervals) {
      throw Error(ErrorCode::did_not_converge, "the phase crossovers could not be isolated");
    }
    const auto [begin, end] = stack.back();
    stack.pop_back();
    const BoundedJet f = locus.phase(begin, end);
    const double noise = rounding * f.weight;
    if (std::abs(f.value) > std::abs(f.slope) + 0.5 * f.bend + noise) {  // no root
      if (undecided_begin >= 0.0) close_run();
      continue;
    }
    if (std::abs(f.slope) > f.bend + noise) {  // monotone: at most one root
      if (undecided_begin >= 0.0) close_run();
      const double phase_begin = locus.phase(begin);
      const double phase_end = locus.phase(end);
      if ((phase_begin > 0.0) != (phase_end > 0.0)) {
        roots.push_back({polish(locus, begin, end, phase_begin, phase_end), phase_end > 0.0 ? 1 : -1});
      }
      continue;
    }
    if (f.size() <= 4.0 * noise || end - begin <= narrowest * end) {
      if (undecided_begin < 0.0) undecided_begin = begin;
      undecided_end = end;
      continue;
    }
    const double middle = 0.5 * (begin + end);
    stack.push_back({middle, end});
    stack.push_back({begin, middle});
  }
  close_run();
  return roots;
}

}  // namespace zwidth
