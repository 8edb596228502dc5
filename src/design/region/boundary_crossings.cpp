#include "design/region/boundary_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "staged_progress.hpp"

namespace zwidth::internal {
namespace {

using Jet = BoundaryCurve::Jet;

// Pairs of parts looked at for two segments, and in all.
constexpr std::size_t max_parts = 4000;
constexpr std::size_t max_pairs = 1'000'000;
// Places in which two segments, and all of them, touch to rounding: where they lie on one another more tell nothing.
constexpr std::size_t max_touches = 32;
constexpr std::size_t max_touches_in_all = 2000;
constexpr int max_newton_steps = 60;
constexpr double newton_tolerance = 1e-13;  // of a segment's half length, or of |K| + |B|/T
// Steps this small, as a share of the half length, that do not halve any more move within rounding: along a segment
// that is steep beside a pole the curve is not known any better.
constexpr double rounding_steps = 1e-6;
constexpr double end_tolerance = 1e-6;  // the same: a crossing this far outside still counts
constexpr double greatest_uncertainty = 0.4;

bool are_apart(const Jet& a, const Jet& b) { return greatest(a) < least(b) || greatest(b) < least(a); }

// Apart along the normal of a.
bool are_apart_across(const BoundarySegment& a, const BoundarySegment& b) {
  const double offset = (b.stiffness.value - a.stiffness.value) * a.damping.slope -
                        (b.damping.value - a.damping.value) * a.stiffness.slope;
  const auto reach = [&](const BoundarySegment& s) {
    return std::abs(s.stiffness.slope * a.damping.slope - s.damping.slope * a.stiffness.slope) +
           0.5 * (s.stiffness.bend * std::abs(a.damping.slope) + s.damping.bend * std::abs(a.stiffness.slope));
  };
  return std::abs(offset) > reach(a) + reach(b);
}

bool run_alike(int a, int b) { return a != 0 && a == b; }

// Segments that follow one another and both rise (or fall) in one quantity meet at their common end alone.
bool part_for_good(const BoundarySegment& a, const BoundarySegment& b) {
  return run_alike(a.damping_sign(), b.damping_sign()) || run_alike(a.stiffness_sign(), b.stiffness_sign());
}

double cross_product(const BoundarySegment& a, const BoundarySegment& b) {
  return a.stiffness.slope * b.damping.slope - a.damping.slope * b.stiffness.slope;
}

// Directions of a and b differ everywhere: at most one crossing, which simplified Newton steps reach.
bool are_transversal(const BoundarySegment& a, const BoundarySegment& b) {
  const double uncertainty =
      a.stiffness.bend * (std::abs(b.damping.slope) + b.damping.bend) + std::abs(a.stiffness.slope) * b.damping.bend +
      a.damping.bend * (std::abs(b.stiffness.slope) + b.stiffness.bend) + std::abs(a.damping.slope) * b.stiffness.bend;
  return uncertainty <= greatest_uncertainty * std::abs(cross_product(a, b));
}

class CrossingSearch {
 public:
  explicit CrossingSearch(const BoundaryCurve& curve) : curve_(curve), period_(curve.plant().period) {}

  void compare(const BoundarySegment& a, const BoundarySegment& b, bool adjacent) {
    parts_left_ = std::min(max_parts, pairs_left_);
    touches_left_ = std::min(max_touches, touches_left_in_all_);
    const std::size_t touches = touches_left_;
    const std::size_t before = parts_left_;
    divide(a, b, adjacent);
    pairs_left_ -= before - parts_left_;
    touches_left_in_all_ -= touches - touches_left_;
  }

  std::vector<WallPoint> crossings;
  bool complete = true;

 private:
  void divide(const BoundarySegment& a, const BoundarySegment& b, bool adjacent) {
    if (parts_left_ == 0 || touches_left_ == 0) {
      complete = false;
      return;
    }
    --parts_left_;
    if (are_apart(a.damping, b.damping) || are_apart(a.stiffness, b.stiffness)) return;
    if (adjacent ? part_for_good(a, b) : are_apart_across(a, b) || are_apart_across(b, a)) return;
    if (!adjacent && are_transversal(a, b)) {
      const Meeting meeting = meet(a, b);
      if (meeting.found) add(meeting.wall);
      if (meeting.converged) return;
    }
    const bool a_is_point = is_point(a, period_);
    if (a_is_point && is_point(b, period_)) {
      if (!adjacent) touch(a, b);
      return;
    }
    // The longer one is divided; a straight line only where the other is a point.
    const bool divide_a = !a_is_point && (is_point(b, period_) || size(a) >= size(b));
    const auto parts = halves(curve_, divide_a ? a : b);
    if (!parts) {
      touch(a, b);
      return;
    }
    if (divide_a) {
      divide((*parts)[0], b, false);
      divide((*parts)[1], b, adjacent);
    } else {
      divide(a, (*parts)[0], adjacent);
      divide(a, (*parts)[1], false);
    }
  }

  struct Meeting {
    bool converged = false;
    bool found = false;
    WallPoint wall;
  };

  void add(const WallPoint& wall) {
    if (wall.damping >= 0.0 && wall.stiffness >= -finest_detail * wall.damping / period_) crossings.push_back(wall);
  }

  // A straight segment is known best.
  void touch(const BoundarySegment& a, const BoundarySegment& b) {
    --touches_left_;
    const BoundarySegment& known = b.straight ? b : a;
    add({known.stiffness.value, known.damping.value});
  }

  [[nodiscard]] double size(const BoundarySegment& s) const {
    return std::abs(s.stiffness.slope) * period_ + std::abs(s.damping.slope);
  }

  // Solves a(s) = b(t) with the slopes at the centres.
  [[nodiscard]] Meeting meet(const BoundarySegment& a, const BoundarySegment& b) const {
    const double determinant = cross_product(b, a);
    // On the way the smaller of the two may be left by far.
    const double larger = std::max(size(a), size(b));
    const double share_a = size(a) / larger;
    const double share_b = size(b) / larger;
    double s = 0.0;
    double t = 0.0;
    double last_step = std::numeric_limits<double>::infinity();
    for (int step = 0; step < max_newton_steps; ++step) {
      const WallPoint at_a = point_of(curve_, a, s);
      const WallPoint at_b = point_of(curve_, b, t);
      const double stiffness = at_b.stiffness - at_a.stiffness;
      const double damping = at_b.damping - at_a.damping;
      const double ds = (b.stiffness.slope * damping - b.damping.slope * stiffness) / determinant;
      const double dt = (a.stiffness.slope * damping - a.damping.slope * stiffness) / determinant;
      s += ds;
      t += dt;
      if (!(std::max(share_a * std::abs(s), share_b * std::abs(t)) < 3.0)) return {true, false, {}};
      const double rounding = newton_tolerance * (std::abs(at_a.stiffness) * period_ + std::abs(at_a.damping));
      const bool meets = std::abs(stiffness) * period_ + std::abs(damping) <= rounding;
      const double this_step = std::max(std::abs(ds), std::abs(dt));
      const bool rounded = this_step <= rounding_steps && this_step > 0.5 * last_step;
      if (meets || rounded || this_step <= newton_tolerance) {
        const double reached = std::max(std::abs(s), std::abs(t));
        return {true, reached <= 1.0 + end_tolerance, b.straight ? at_b : at_a};
      }
      last_step = this_step;
    }
    return {};
  }

  const BoundaryCurve& curve_;
  double period_;
  std::size_t pairs_left_ = max_pairs;
  std::size_t touches_left_in_all_ = max_touches_in_all;
  std::size_t parts_left_ = 0;  // of the two segments compared
  std::size_t touches_left_ = 0;
};

// Numbers runs of segments that follow one another and all rise, or all fall, in one quantity; 0 outside such runs.
std::vector<std::size_t> monotone_runs(std::span<const BoundarySegment> segments,
                                       int (BoundarySegment::*sign)() const) {
  std::vector<std::size_t> runs(segments.size(), 0);
  std::size_t run = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const int here = (segments[i].*sign)();
    if (here == 0) continue;
    const bool goes_on = i > 0 && segments[i].follows && (segments[i - 1].*sign)() == here;
    if (!goes_on) ++run;
    runs[i] = run;
  }
  return runs;
}

}  // namespace

BoundaryCrossings boundary_crossings(const BoundaryCurve& curve, std::span<const BoundarySegment> segments,
                                     const Progress& progress) {
  const std::vector<std::size_t> by_damping = monotone_runs(segments, &BoundarySegment::damping_sign);
  const std::vector<std::size_t> by_stiffness = monotone_runs(segments, &BoundarySegment::stiffness_sign);
  std::vector<std::size_t> order(segments.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return least(segments[i].damping) < least(segments[j].damping); });
  CrossingSearch search(curve);
  for (std::size_t k = 0; k < order.size(); ++k) {
    tell(progress, static_cast<double>(k) / static_cast<double>(order.size()));
    const double top = greatest(segments[order[k]].damping);
    for (std::size_t l = k + 1; l < order.size() && least(segments[order[l]].damping) <= top; ++l) {
      const auto [i, j] = std::minmax(order[k], order[l]);
      if (by_damping[i] != 0 && by_damping[i] == by_damping[j]) continue;
      if (by_stiffness[i] != 0 && by_stiffness[i] == by_stiffness[j]) continue;
      search.compare(segments[i], segments[j], j == i + 1 && segments[j].follows);
    }
  }
  return {std::move(search.crossings), search.complete};
}

}  // namespace zwidth::internal
