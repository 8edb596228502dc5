#include "zwidth/design/stable_region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "design/region/boundary_tracer.hpp"
#include "require_argument.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
using namespace internal;
namespace {

// By Green's theorem; positive where the boundary runs counter-clockwise.
double signed_area(const ClosedBoundary& boundary) {
  if (boundary.arcs.empty()) return 0.0;
  double twice = 0.0;
  const BoundaryPoint* last = &boundary.arcs.back().points.back();
  for (const BoundaryArc& arc : boundary.arcs) {
    for (const BoundaryPoint& point : arc.points) {
      twice += last->stiffness * point.damping - point.stiffness * last->damping;
      last = &point;
    }
  }
  return 0.5 * twice;
}

// A component has one boundary; another could only be a sliver between two routes to the same curve.
constexpr double sliver = 1e-9;

std::vector<StableComponent> components_of(std::vector<TracedBoundary> boundaries) {
  std::map<std::size_t, StableComponent> by_number;
  double largest = 0.0;
  for (const TracedBoundary& traced : boundaries) largest = std::max(largest, signed_area(traced.boundary));
  for (TracedBoundary& traced : boundaries) {
    const double area = signed_area(traced.boundary);
    if (std::abs(area) <= sliver * largest) continue;
    StableComponent& component = by_number[traced.component];
    if (area < 0.0 || !component.outline.arcs.empty()) {
      throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::outline_not_closed});
    }
    component.area = area;
    component.outline = std::move(traced.boundary);
    component.from_zero = std::any_of(component.outline.arcs.begin(), component.outline.arcs.end(),
                                      [](const BoundaryArc& arc) { return arc.kind == BoundaryKind::no_stiffness; });
  }
  std::vector<StableComponent> components;
  components.reserve(by_number.size());
  for (auto& [number, component] : by_number) components.push_back(std::move(component));
  std::sort(components.begin(), components.end(),
            [](const StableComponent& a, const StableComponent& b) { return a.area > b.area; });
  return components;
}

// Largest K and largest B over the outlines; between vertices of the curve K may be larger.
void find_extremes(StableRegion& region, const RegionStructure& structure, double deviation) {
  const auto consider = [&region](const BoundaryPoint& point) {
    if (!region.stiffest || point.stiffness > region.stiffest->stiffness) region.stiffest = point;
    if (!region.most_damped || point.damping > region.most_damped->damping) region.most_damped = point;
  };
  for (const StableComponent& component : region.components) {
    for (const BoundaryArc& arc : component.outline.arcs) {
      for (const BoundaryPoint& point : arc.points) consider(point);
    }
  }
  if (!region.stiffest) return;
  const double worth_refining = region.stiffest->stiffness * (1.0 - 4.0 * deviation);
  for (const StableComponent& component : region.components) {
    for (const BoundaryArc& arc : component.outline.arcs) {
      if (arc.kind != BoundaryKind::oscillation) continue;
      for (std::size_t i = 1; i + 1 < arc.points.size(); ++i) {
        const double here = arc.points[i].stiffness;
        if (here < worth_refining || here < arc.points[i - 1].stiffness || here < arc.points[i + 1].stiffness) continue;
        consider(structure.stiffest_between(arc.points[i - 1], arc.points[i + 1]));
      }
    }
  }
}

}  // namespace

StableRegion stable_region(const StableWalls& walls, OutlineOptions options) {
  require_fraction({"deviation", options.deviation});
  const RegionStructure& structure = walls.structure();
  StableRegion region;
  for (const RegionSlab& slab : structure.slabs) {
    for (const RegionCell& cell : slab.cells) region.bounded = region.bounded && cell.right.has_value();
  }
  const std::vector<StableInterval> undamped = walls.stable_stiffnesses(0.0);
  if (!undamped.empty() && undamped.front().lower == 0.0) {
    region.critical_stiffness = undamped.front().upper.value_or(std::numeric_limits<double>::infinity());
  }
  if (!region.bounded) return region;
  std::vector<TracedBoundary> boundaries = trace_boundaries(structure, options.deviation);
  for (const TracedBoundary& traced : boundaries) region.vertex_error = std::max(region.vertex_error, traced.gap);
  region.components = components_of(std::move(boundaries));
  for (const StableComponent& component : region.components) region.area += component.area;
  find_extremes(region, structure, options.deviation);
  return region;
}

}  // namespace zwidth
