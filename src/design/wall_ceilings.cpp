#include "zwidth/design/wall_ceilings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "stability/any_user_search.hpp"
#include "zwidth/design/any_user_region.hpp"
#include "zwidth/design/stable_region.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/any_user.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int bisections = 24;                     // of a stretch of B
constexpr std::size_t most_bodies_for_users = 20;  // the any-user limit grows with the cube of the bodies

/// The end of the range from `holds` (true at `low`) to `fails` (false at `high`), from below.
template <typename Holds>
double last_that_holds(double low, double high, Holds&& holds) {
  for (int i = 0; i < bisections; ++i) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

/// Least B on the segment where K <= stiffness; infinity where it has none.
double least_damping(const BoundaryPoint& a, const BoundaryPoint& b, double stiffness) {
  double least = infinity;
  for (const BoundaryPoint* end : {&a, &b}) {
    if (end->stiffness <= stiffness) least = std::min(least, end->damping);
  }
  if ((a.stiffness <= stiffness) != (b.stiffness <= stiffness)) {
    const double share = (stiffness - a.stiffness) / (b.stiffness - a.stiffness);
    least = std::min(least, a.damping + share * (b.damping - a.damping));
  }
  return least;
}

/// Least B of the boundary over 0 < K <= stiffness.
double boundary_damping(const StableWalls& walls, const StableRegion& region, double stiffness) {
  double least = infinity;
  for (const StableComponent& component : region.components) {
    for (const BoundaryArc& arc : component.outline.arcs) {
      if (arc.kind == BoundaryKind::no_stiffness || arc.kind == BoundaryKind::no_damping) continue;
      for (std::size_t i = 1; i < arc.points.size(); ++i) {
        least = std::min(least, least_damping(arc.points[i - 1], arc.points[i], stiffness));
      }
    }
  }
  // The outline is a polygon: the exact intervals of K decide beside it.
  const auto holds = [&](double damping) {
    const std::vector<StableInterval> intervals = walls.stable_stiffnesses(damping);
    return !intervals.empty() && intervals.front().lower == 0.0 &&
           intervals.front().upper.value_or(infinity) > stiffness;
  };
  constexpr double beside = 0.05;
  const double low = (1.0 - beside) * least;
  const double high = (1.0 + beside) * least;
  if (!holds(low)) return last_that_holds(0.0, low, holds);
  return holds(high) ? least : last_that_holds(low, high, holds);
}

/// Least B at which the any-user limit is not above `stiffness`.
double any_user_damping(const Device& device, const AnyUserRegion& region, double stiffness) {
  const double filter = device.parameters().wall.velocity_filter_hz;
  const std::vector<AnyUserPoint>& limit = region.ranges.front();  // from B = 0, where the limit is above 0
  const auto first_below = std::ranges::find_if(limit, [&](const AnyUserPoint& p) { return p.stiffness <= stiffness; });
  if (first_below == limit.begin()) return 0.0;
  if (first_below == limit.end()) return limit.back().damping;
  AnyUserSearch search(device);
  return last_that_holds(std::prev(first_below)->damping, first_below->damping, [&](double damping) {
    return search.limit({damping, filter}).stiffness > stiffness;
  });
}

}  // namespace

std::optional<WallCeilings> wall_ceilings(const Device& device, double safety_factor) {
  if (!(safety_factor > 0.0 && safety_factor < 1.0)) {
    throw Error(ErrorCode::invalid_argument,
                "the safety factor is " + std::to_string(safety_factor) + "; must be above 0 and below 1");
  }
  const double filter = device.parameters().wall.velocity_filter_hz;
  const StableWalls walls(filtered_plant(device), filter);
  const StableRegion region = stable_region(walls);
  if (!region.bounded || !(region.critical_stiffness > 0.0)) return std::nullopt;
  WallCeilings ceilings;
  ceilings.limit = region.critical_stiffness;
  if (device.has_bodies() && device.bodies().size() <= most_bodies_for_users) {
    const double any_user = any_user_limit(device, {0.0, filter}).stiffness;
    if (any_user > 0.0 && std::isfinite(any_user)) {
      ceilings.basis = WallCeilings::Basis::any_user;
      ceilings.limit = any_user;
    }
  }
  ceilings.stiffness = safety_factor * ceilings.limit;
  ceilings.damping_limit =
      ceilings.basis == WallCeilings::Basis::any_user
          ? any_user_damping(device, any_user_region(device, filter, region.most_damped->damping), ceilings.stiffness)
          : boundary_damping(walls, region, ceilings.stiffness);
  ceilings.damping = safety_factor * ceilings.damping_limit;
  return ceilings;
}

}  // namespace zwidth
