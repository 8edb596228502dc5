#include "design/region/boundary_segment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "stability/loop/plant_fraction.hpp"
#include "stability/roots/root_isolation.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

using Jet = BoundaryCurve::Jet;

// Intervals looked at: with bounds, and for each whole sample of delay; with estimates.
constexpr std::size_t intervals_per_report = 64;  // of progress
constexpr std::size_t max_bounded_intervals = 30000;
constexpr std::size_t max_bounded_per_piece = 300;
constexpr std::size_t max_estimated_intervals = 200000;
// With estimates: divisions of the range of angles, and ever closer to every pole down to a share of its own damping.
constexpr int even_divisions = 256;
constexpr double nearest_division = 0.25;
constexpr double narrowest_estimate = 1e-12;
constexpr double estimate_margin = 2.0;   // on second differences
constexpr double finest_estimate = 1e-8;  // in place of finest_detail: second differences magnify rounding

// 1/g; g keeps its sign by at least `least_size` > 0.
Jet reciprocal(const Jet& g, double least_size) {
  const double inverse = 1.0 / g.value;
  const double slope = g.slope_size();
  const double squared = least_size * least_size;
  return {inverse, -g.slope * inverse * inverse, g.bend / squared + 2.0 * slope * slope / (squared * least_size), 0.0};
}

// Not to be divided further.
bool is_narrow(double begin, double end, bool estimated) {
  return end - begin <= (estimated ? narrowest_estimate : root_isolation::narrowest) * end;
}

// No stable wall on the interval: outside the quadrant or the bounds.
bool is_outside(const BoundaryCurve::Model& model, const CurveBounds& bounds, double largest_wall) {
  if (greatest(model.stiffness) < 0.0 || greatest(model.damping) < 0.0) return true;
  const double seen = greatest(model.seen);
  // |K + B v| = |D|/|S|
  return least(model.open) > largest_wall * largest_wall * seen || least(model.damping) > bounds.damping * seen ||
         least(model.stiffness) > bounds.stiffness * seen;
}

std::optional<BoundarySegment> quotient(const BoundaryCurve::Model& model, double begin, double end) {
  const double least_seen = least(model.seen);
  if (!(least_seen > 0.0)) return std::nullopt;
  const Jet inverse = reciprocal(model.seen, least_seen);
  return BoundarySegment{model.stiffness * inverse, model.damping * inverse, begin, end};
}

bool is_settled(const BoundarySegment& segment, double period) {
  if (std::abs(segment.damping.slope) >= 2.0 * segment.damping.bend) return true;
  const double damping = std::abs(segment.damping.value) + period * std::abs(segment.stiffness.value);
  const double detail = segment.estimated ? finest_estimate : finest_detail;
  return std::abs(segment.stiffness.slope) >= 2.0 * segment.stiffness.bend &&
         std::abs(segment.damping.slope) + segment.damping.bend <= detail * damping;
}

}  // namespace

bool is_point(const BoundarySegment& segment, double period) {
  if (!segment.straight && is_narrow(segment.begin, segment.end, segment.estimated)) return true;
  const auto size = [](const Jet& a) { return std::abs(a.slope) + a.bend; };
  const double stiffness = std::abs(segment.stiffness.value);
  const double damping = std::abs(segment.damping.value);
  return size(segment.stiffness) <= finest_detail * (stiffness + damping / period) &&
         size(segment.damping) <= finest_detail * (damping + period * stiffness);
}

std::optional<BoundarySegment> curve_segment(const BoundaryCurve& curve, double begin, double end) {
  return quotient(curve.model(begin, end), begin, end);
}

std::optional<BoundarySegment> estimated_segment(const BoundaryCurve& curve, double begin, double end) {
  constexpr std::size_t count = 7;
  std::array<double, count> stiffness{};
  std::array<double, count> damping{};
  for (std::size_t i = 0; i < count; ++i) {
    const double x = begin + (end - begin) * static_cast<double>(i) / (count - 1);
    const WallPoint wall = curve.at(angle_of(std::min(x, end)));
    if (!std::isfinite(wall.stiffness) || !std::isfinite(wall.damping)) return std::nullopt;
    stiffness[i] = wall.stiffness;
    damping[i] = wall.damping;
  }
  const auto jet = [](const std::array<double, count>& f) {
    constexpr double step = 2.0 / (count - 1);
    double least_bend = std::numeric_limits<double>::infinity();
    double greatest_bend = -least_bend;
    for (std::size_t i = 1; i + 1 < count; ++i) {
      const double bend = (f[i - 1] - 2.0 * f[i] + f[i + 1]) / (step * step);
      least_bend = std::min(least_bend, bend);
      greatest_bend = std::max(greatest_bend, bend);
    }
    const double size = std::max(std::abs(least_bend), std::abs(greatest_bend));
    const double bend = estimate_margin * (size + (greatest_bend - least_bend));
    return Jet{f[count / 2], 0.5 * (f[count - 1] - f[0]), bend, 0.0};
  };
  BoundarySegment segment{jet(stiffness), jet(damping), begin, end};
  segment.estimated = true;
  return segment;
}

WallPoint point_of(const BoundaryCurve& curve, const BoundarySegment& segment, double u) {
  if (segment.straight) {
    return {segment.stiffness.value + u * segment.stiffness.slope, segment.damping.value + u * segment.damping.slope};
  }
  const double x = 0.5 * (segment.begin + segment.end) + 0.5 * u * (segment.end - segment.begin);
  return curve.at(angle_of(std::clamp(x, 0.0, 4.0)));
}

std::optional<std::array<BoundarySegment, 2>> halves(const BoundaryCurve& curve, const BoundarySegment& segment) {
  if (segment.straight) {
    const auto part = [](const Jet& a, double centre) {
      return Jet{a.value + centre * a.slope, 0.5 * a.slope, 0.0, 0.0};
    };
    const double middle = 0.5 * (segment.begin + segment.end);
    return std::array<BoundarySegment, 2>{
        BoundarySegment{part(segment.stiffness, -0.5), part(segment.damping, -0.5), segment.begin, middle, true},
        BoundarySegment{part(segment.stiffness, 0.5), part(segment.damping, 0.5), middle, segment.end, true}};
  }
  const double middle = root_isolation::division(segment.begin, segment.end);
  const auto part = segment.estimated ? estimated_segment : curve_segment;
  const auto first = part(curve, segment.begin, middle);
  const auto second = part(curve, middle, segment.end);
  if (!first || !second) return std::nullopt;
  return std::array<BoundarySegment, 2>{*first, *second};
}

namespace {

struct Interval {
  double begin;
  double end;
};

// Joins segments that follow one another.
class SegmentList {
 public:
  void add(BoundarySegment segment) {
    segment.follows = segment.begin == reached_;
    reached_ = segment.end;
    segments.push_back(segment);
  }
  std::vector<BoundarySegment> segments;

 private:
  double reached_ = -1.0;  // where the last segment ended
};

// Nothing past the cap.
std::optional<std::vector<BoundarySegment>> bounded_segments(const BoundaryCurve& curve, const CurveBounds& bounds,
                                                             const Progress& progress) {
  const double largest_wall = bounds.stiffness + bounds.damping * curve.velocity_at_nyquist();
  const std::size_t pieces = std::max<std::size_t>(1, curve.plant().delay_samples);
  std::vector<Interval> stack;
  double right = 4.0;
  for (std::size_t i = pieces; i-- > 0;) {  // leftmost on top
    const double half_sine = std::sin(0.5 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(pieces));
    stack.push_back({4.0 * half_sine * half_sine, right});
    right = stack.back().begin;
  }
  SegmentList list;
  for (std::size_t left = max_bounded_intervals + max_bounded_per_piece * pieces; !stack.empty(); --left) {
    if (left == 0) return std::nullopt;
    if (left % intervals_per_report == 0) tell(progress, 0.0);
    const auto [begin, end] = stack.back();
    stack.pop_back();
    const BoundaryCurve::Model model = curve.model(begin, end);
    if (is_outside(model, bounds, largest_wall)) continue;
    const std::optional<BoundarySegment> segment = quotient(model, begin, end);
    const bool narrow = is_narrow(begin, end, false);
    if (segment && (narrow || is_settled(*segment, curve.plant().period))) {
      list.add(*segment);
    } else if (!narrow) {  // where P vanishes on a narrow interval the curve passes through infinity
      const double middle = root_isolation::division(begin, end);
      stack.push_back({middle, end});
      stack.push_back({begin, middle});
    }
  }
  return std::move(list.segments);
}

// Where samples gather: evenly in angle, by ratios towards z = 1, and ever closer to every pole.
std::vector<double> first_divisions(const BoundaryCurve& curve) {
  const SampledPlant& plant = curve.plant();
  std::vector<double> divisions{0.0, 4.0};
  const auto add = [&](double angle) {
    if (!(angle > 0.0 && angle < std::numbers::pi)) return;
    const double half_sine = std::sin(0.5 * angle);
    divisions.push_back(4.0 * half_sine * half_sine);
  };
  const double even = even_divisions + 16.0 * static_cast<double>(plant.delay_samples);
  for (double i = 1.0; i < even; i += 1.0) add(std::numbers::pi * i / even);
  for (double angle = std::numbers::pi / even; angle > 1e-6; angle *= 0.5) add(angle);
  for (const SampledTerm& term : plant.terms) {
    if (term.degree != 2) continue;
    // delta² + d1 delta + d0, the pole 1 + delta
    const double half = -0.5 * term.denominator[1];
    const double square = term.denominator[0] - half * half;
    if (!(square > 0.0)) continue;
    const double angle = std::atan2(std::sqrt(square), 1.0 + half);
    const double radius = std::hypot(std::sqrt(square), 1.0 + half);
    const double nearest = std::max(nearest_division * std::abs(1.0 - radius), narrowest_estimate * angle);
    add(angle);
    for (double distance = 0.5 * angle; distance > nearest; distance *= 0.5) {
      add(angle - distance);
      add(angle + distance);
    }
  }
  std::sort(divisions.begin(), divisions.end());
  divisions.erase(std::unique(divisions.begin(), divisions.end()), divisions.end());
  return divisions;
}

// Clearly outside the quadrant or the bounds, by twice what the samples show.
bool is_outside(const BoundarySegment& segment, const CurveBounds& bounds) {
  const auto reach = [](const Jet& a) { return 2.0 * std::abs(a.slope) + a.bend; };
  return segment.stiffness.value + reach(segment.stiffness) < 0.0 ||
         segment.damping.value + reach(segment.damping) < 0.0 ||
         segment.stiffness.value - reach(segment.stiffness) > bounds.stiffness ||
         segment.damping.value - reach(segment.damping) > bounds.damping;
}

// Both ends of an interval that cannot be divided are outside: P vanishes between.
bool leaves_through_infinity(const BoundaryCurve& curve, double begin, double end, const CurveBounds& bounds) {
  const auto outside = [&](double x) {
    const WallPoint wall = curve.at(angle_of(x));
    return !(wall.stiffness >= 0.0 && wall.stiffness <= bounds.stiffness && wall.damping >= 0.0 &&
             wall.damping <= bounds.damping);
  };
  return outside(begin) && outside(end);
}

std::vector<BoundarySegment> estimated_segments(const BoundaryCurve& curve, const CurveBounds& bounds,
                                                const Progress& progress) {
  const std::vector<double> divisions = first_divisions(curve);
  std::vector<Interval> stack;
  for (std::size_t i = divisions.size() - 1; i-- > 0;) stack.push_back({divisions[i], divisions[i + 1]});
  SegmentList list;
  for (std::size_t left = max_estimated_intervals; !stack.empty(); --left) {
    if (left == 0) {
      throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::boundary_not_followed});
    }
    if (left % intervals_per_report == 0) tell(progress, 0.0);
    const auto [begin, end] = stack.back();
    stack.pop_back();
    const std::optional<BoundarySegment> segment = estimated_segment(curve, begin, end);
    if (segment && is_outside(*segment, bounds)) continue;
    const bool narrow = is_narrow(begin, end, true);
    if (narrow && leaves_through_infinity(curve, begin, end, bounds)) continue;
    if (segment && (narrow || is_settled(*segment, curve.plant().period))) {
      list.add(*segment);
    } else if (!narrow) {
      const double middle = root_isolation::division(begin, end);
      stack.push_back({middle, end});
      stack.push_back({begin, middle});
    }
  }
  return std::move(list.segments);
}

}  // namespace

CurveSegments curve_segments(const BoundaryCurve& curve, const CurveBounds& bounds, const Progress& progress) {
  if (auto bounded = bounded_segments(curve, bounds, progress)) return {*std::move(bounded), true};
  return {estimated_segments(curve, bounds, progress), false};
}

}  // namespace zwidth::internal
