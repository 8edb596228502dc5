#include "design/boundary_segment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stability/plant_fraction.hpp"
#include "stability/root_isolation.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

using Jet = BoundaryCurve::Jet;

constexpr std::size_t max_intervals_per_piece = 100000;

// 1/g; g keeps its sign by at least `least_size` > 0.
Jet reciprocal(const Jet& g, double least_size) {
  const double inverse = 1.0 / g.value;
  const double slope = g.slope_size();
  const double squared = least_size * least_size;
  return {inverse, -g.slope * inverse * inverse, g.bend / squared + 2.0 * slope * slope / (squared * least_size), 0.0};
}

// Not to be divided further.
bool is_narrow(double begin, double end) { return end - begin <= root_isolation::narrowest * end; }

// No stable wall on the interval: outside the quadrant or the bounds.
bool is_outside(const BoundaryCurve::Model& model, const WallBounds& bounds, double largest_wall) {
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
  return std::abs(segment.stiffness.slope) >= 2.0 * segment.stiffness.bend &&
         std::abs(segment.damping.slope) + segment.damping.bend <= finest_detail * damping;
}

}  // namespace

bool is_point(const BoundarySegment& segment, double period) {
  if (!segment.straight && is_narrow(segment.begin, segment.end)) return true;
  const auto size = [](const Jet& a) { return std::abs(a.slope) + a.bend; };
  const double stiffness = std::abs(segment.stiffness.value);
  const double damping = std::abs(segment.damping.value);
  return size(segment.stiffness) <= finest_detail * (stiffness + damping / period) &&
         size(segment.damping) <= finest_detail * (damping + period * stiffness);
}

std::optional<BoundarySegment> curve_segment(const BoundaryCurve& curve, double begin, double end) {
  return quotient(curve.model(begin, end), begin, end);
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
  const auto first = curve_segment(curve, segment.begin, middle);
  const auto second = curve_segment(curve, middle, segment.end);
  if (!first || !second) return std::nullopt;
  return std::array<BoundarySegment, 2>{*first, *second};
}

std::vector<BoundarySegment> curve_segments(const BoundaryCurve& curve, const WallBounds& bounds) {
  struct Interval {
    double begin;
    double end;
  };
  const double largest_wall = bounds.stiffness + bounds.damping * curve.velocity_at_nyquist();
  const std::size_t pieces = std::max<std::size_t>(1, curve.plant().delay_samples);
  std::vector<Interval> stack;
  double right = 4.0;
  for (std::size_t i = pieces; i-- > 0;) {  // leftmost on top
    const double half_sine = std::sin(0.5 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(pieces));
    stack.push_back({4.0 * half_sine * half_sine, right});
    right = stack.back().begin;
  }
  std::vector<BoundarySegment> segments;
  double reached = -1.0;  // where the last segment ended
  for (std::size_t left = max_intervals_per_piece * pieces; !stack.empty(); --left) {
    if (left == 0) {
      throw Error(ErrorCode::did_not_converge,
                  "the stability boundary could not be followed: boundaries of many bodies meet too closely");
    }
    const auto [begin, end] = stack.back();
    stack.pop_back();
    const BoundaryCurve::Model model = curve.model(begin, end);
    if (is_outside(model, bounds, largest_wall)) continue;
    std::optional<BoundarySegment> segment = quotient(model, begin, end);
    const bool narrow = is_narrow(begin, end);
    if (segment && (narrow || is_settled(*segment, curve.plant().period))) {
      segment->follows = begin == reached;
      segments.push_back(*segment);
      reached = end;
    } else if (!narrow) {  // where P vanishes on a narrow interval the curve passes through infinity
      const double middle = root_isolation::division(begin, end);
      stack.push_back({middle, end});
      stack.push_back({begin, middle});
    }
  }
  return segments;
}

}  // namespace zwidth::internal
