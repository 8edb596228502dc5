#pragma once

#include <array>
#include <optional>
#include <vector>

#include "design/region/boundary_curve.hpp"
#include "design/region/wall_bounds.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

// A piece of boundary with K and B as first-order Taylor models in u in [-1, 1]: of the curve, on an interval of
// x = |z - 1|², or of a straight line.
struct BoundarySegment {
  BoundaryCurve::Jet stiffness;
  BoundaryCurve::Jet damping;
  double begin = 0.0;
  double end = 0.0;
  bool straight = false;
  bool estimated = false;  // the bends are estimates from samples, not bounds
  bool follows = false;    // the segment before it in the list ends where it begins

  // +1 or -1 where the quantity certainly rises or falls from begin to end, else 0.
  [[nodiscard]] int damping_sign() const { return sign(damping); }
  [[nodiscard]] int stiffness_sign() const { return sign(stiffness); }

 private:
  [[nodiscard]] static int sign(const BoundaryCurve::Jet& a) {
    return std::abs(a.slope) <= a.bend ? 0 : a.slope > 0.0 ? 1 : -1;
  }
};

// Details smaller than this share of |B| + T |K| (or |K| + |B|/T) are points.
inline constexpr double finest_detail = 1e-10;

// Smaller than finest_detail in K and B, or too narrow to be divided.
bool is_point(const BoundarySegment& segment, double period);

// K and B as quotients; nothing where P may vanish on the interval.
std::optional<BoundarySegment> curve_segment(const BoundaryCurve& curve, double begin, double end);

// The same with bends estimated from samples; nothing where one is not finite.
std::optional<BoundarySegment> estimated_segment(const BoundaryCurve& curve, double begin, double end);

WallPoint point_of(const BoundaryCurve& curve, const BoundarySegment& segment, double u);

// Both halves; nothing where a model fails.
std::optional<std::array<BoundarySegment, 2>> halves(const BoundaryCurve& curve, const BoundarySegment& segment);

// The curve within K >= 0, B >= 0 and the bounds (and somewhat beyond), by rising x, in segments on each of which B
// certainly rises or falls, or K does and B changes by less than finest_detail of itself.
//
// Bounds of the products of many factors are wide, those of a device that is hardly damped are lost in rounding. Where
// they would take more than a cap of intervals, second derivatives are estimated instead, from samples that gather
// around every pole; whoever relies on such segments must check what follows.
// Throws Error (did_not_converge) past a cap on the number of those.
struct CurveSegments {
  std::vector<BoundarySegment> segments;
  bool proven = true;  // no estimates
};
CurveSegments curve_segments(const BoundaryCurve& curve, const CurveBounds& bounds, const Progress& progress = {});

}  // namespace zwidth::internal
