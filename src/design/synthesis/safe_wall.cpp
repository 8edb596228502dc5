#include "zwidth/design/safe_wall.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "design/synthesis/known_holders.hpp"
#include "design/synthesis/wall_limits.hpp"
#include "infinity.hpp"
#include "model/known_structure.hpp"
#include "stability/device_draws.hpp"
#include "stability/limit/guarded_stiffness.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "stability/second_route/pole_count.hpp"
#include "stability/users/any_user_limit.hpp"
#include "stability/users/any_user_limits.hpp"
#include "zwidth/design/absolute_stability_region.hpp"
#include "zwidth/design/stable_region.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/require_valid.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr int bisections = 24;  // of a stretch of B

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

/// Least B at which the absolute stability limit is not above `stiffness`.
double absolute_stability_damping(const Device& device, const AbsoluteStabilityRegion& region, double stiffness) {
  const double filter = device.parameters().wall.velocity_filter_hz;
  if (region.ranges.empty()) return 0.0;
  const std::vector<AbsoluteStabilityPoint>& limit = region.ranges.front();  // from B = 0, where the limit is above 0
  const auto first_below =
      std::ranges::find_if(limit, [&](const AbsoluteStabilityPoint& p) { return p.stiffness <= stiffness; });
  if (first_below == limit.begin()) return 0.0;
  if (first_below == limit.end()) return limit.back().damping;
  AnyUserLimits limits(device);
  return last_that_holds(std::prev(first_below)->damping, first_below->damping, [&](double damping) {
    return limits.limit({damping, filter}).lower_bound() > stiffness;
  });
}

/// Of the uncertainty nothing is lost.
Device with_damping(const Device& device, double damping) {
  DeviceParameters parameters = device.parameters();
  parameters.wall.damping = damping;
  return Device(std::move(parameters));
}

/// Leaves the trust alone.
SafeWall refused(SafeWall wall) {
  SafeWall result;
  result.status = SafeWall::Status::refused;
  result.trust = std::move(wall.trust);
  return result;
}

/// Asks the second route.
void check(const Device& device, double stiffness, double damping, Trust& trust) {
  const Device walled = with_wall(device, stiffness, {damping, device.parameters().wall.velocity_filter_hz});
  if (!has_damper_loop(walled.loop()) || damping == 0.0) {
    distrust(agreement(PoleCount(with_one_rate(walled)), stiffness, true), stiffness, trust);
  } else {
    const TwoRateDevice loop(walled, damping);
    distrust(agreement(loop, loop.as_it_runs(walled), stiffness, true), stiffness, trust);
  }
}

void check_wall(const std::vector<Device>& holders, const SafeWallOptions& options, SafeWall& wall) {
  for (const Device& held : holders) {
    if (options.damping == SafeWallOptions::Damping::own) {
      if (!wall.trust.refused()) check(held, wall.stiffness, wall.damping, wall.trust);
      continue;
    }
    for (const double stiffness : {1e-3, 0.5, 1.0}) {
      for (const double damping : {0.0, 0.5, 1.0}) {
        if (wall.trust.refused()) return;
        check(held, stiffness * wall.stiffness, damping * wall.damping, wall.trust);
      }
    }
  }
}

bool is_uncertain(const Device& device) {
  const std::optional<Uncertainty>& uncertainty = device.parameters().uncertainty;
  return uncertainty && !uncertainty->parameters.empty();
}

/// Whether all but 2.5 % of the devices that the uncertainty allows keep every wall up to these two whoever holds them.
bool most_keep(const std::vector<Device>& devices, double stiffness, VirtualDamper damper) {
  std::size_t failed = 0;
  for (const Device& each : devices) {
    if (!bounds_all_users(each)) {
      ++failed;
      continue;
    }
    AnyUserLimits limits(each);
    const bool fails = std::ranges::any_of(std::array{0.0, 0.5, 1.0}, [&](double share) {
      return limits.limit({share * damper.damping, damper.velocity_filter_hz}).lower_bound() < stiffness;
    });
    failed += fails;
  }
  return 40 * failed <= devices.size();
}

/// The ceiling on B that the devices of the uncertainty leave beside the one on K: both limits move with it, each its own way.
void lower_damping(const Device& device, std::size_t draws, double filter, SafeWall& wall) {
  DeviceDraws drawn(device, usual_draws_seed);
  std::vector<Device> devices;
  for (std::size_t i = 0; i < draws; ++i) devices.push_back(drawn.next());
  constexpr double less = 0.8;
  constexpr int most_steps = 20;
  for (int i = 0; i < most_steps; ++i, wall.damping *= less) {
    if (most_keep(devices, wall.stiffness, {wall.damping, filter})) return;
  }
  wall.damping = 0.0;
}

/// A known holder of the device, its damper closed, and the limit that this leaves.
struct KnownHolderLimit {
  Device device;
  CriticalStiffness critical;
};

/// What the uncertainty leaves of every limit.
void take_lower_bounds(const std::vector<KnownHolderLimit>& held, const KnownHolderLimit& least,
                       const SafeWallOptions& options, SafeWall& wall) {
  if (!is_uncertain(held.back().device)) return;
  for (const KnownHolderLimit& each : held) {
    if (each.critical.status != StiffnessStatus::finite || !is_uncertain(each.device)) continue;
    const StiffnessInterval interval = stiffness_interval(each.device, options.draws);
    wall.uncertainty_share =
        std::min(wall.uncertainty_share, std::clamp(interval.lower / each.critical.stiffness, 0.0, 1.0));
    if (&each == &least) wall.interval = interval;
  }
  if (wall.basis == SafeWall::Basis::any_user) {
    const Wall& own = held.back().device.parameters().wall;
    wall.absolute_stability_interval =
        absolute_stability_interval(held.back().device, {own.damping, own.velocity_filter_hz}, options.any_user_draws);
    wall.uncertainty_share = std::min(wall.uncertainty_share, wall.absolute_stability_interval->lower / wall.limit);
  }
  wall.remarks.push_back(
      note({.code = FindingCode::limits_at_lower_end, .evidence = {{"share", wall.uncertainty_share}}}));
}

/// The limits of all known holders; of each the status decides where there is none.
std::vector<KnownHolderLimit> limits_of_holders(const std::vector<Device>& holders, bool own, SafeWall& wall) {
  std::vector<KnownHolderLimit> held;
  for (const Device& each : holders) {
    const Device closed = own ? each : with_damping(each, 0.0);
    held.push_back({closed, critical_stiffness(closed)});
    wall.trust.inherit(held.back().critical.trust);
  }
  const auto has = [&](StiffnessStatus status) {
    return [status](const KnownHolderLimit& each) { return each.critical.status == status; };
  };
  if (std::ranges::any_of(held, has(StiffnessStatus::none_stable))) {
    wall.status = SafeWall::Status::none_stable;
  } else if (std::ranges::all_of(held, has(StiffnessStatus::unbounded))) {
    wall.status = SafeWall::Status::unbounded;
  }
  return held;
}

/// Least B at which a wall up to the stiffness chosen is not stable.
double damping_limit(const std::vector<Device>& holders, SafeWall& wall) {
  double least = infinity;
  for (const Device& each : holders) {
    const StableWalls walls(each);
    const StableRegion region = stable_region(walls);
    if (!region.bounded) continue;
    if (!region.most_damped) {
      wall.trust.refuse({.code = FindingCode::region_contradicts_limit});
      return 0.0;
    }
    if (wall.basis == SafeWall::Basis::any_user) {  // nobody is among them, and the first
      const AbsoluteStabilityRegion users = absolute_stability_region(each, walls, region.most_damped->damping);
      wall.trust.inherit(users.trust);
      return users.trust.refused() ? 0.0 : absolute_stability_damping(each, users, wall.stiffness);
    }
    least = std::min(least, boundary_damping(walls, region, wall.stiffness));
  }
  return least;
}

void choose(const Device& device, const SafeWallOptions& options, SafeWall& wall) {
  const bool own = options.damping == SafeWallOptions::Damping::own;
  const double filter = device.parameters().wall.velocity_filter_hz;
  wall.damping = own ? device.parameters().wall.damping : 0.0;
  const std::vector<Device> holders = known_holders(device);
  const std::vector<KnownHolderLimit> held = limits_of_holders(holders, own, wall);
  if (wall.trust.refused() || wall.status != SafeWall::Status::chosen) return;
  const KnownHolderLimit& least =
      *std::ranges::min_element(held, {}, [](const KnownHolderLimit& each) { return each.critical.stiffness; });
  wall.limit = least.critical.stiffness;
  if (can_be_held(device)) {
    const AbsoluteStabilityLimit any_user = known_any_user_limit(own ? device : with_damping(device, 0.0));
    if (any_user.trust.refused()) return wall.trust.inherit(any_user.trust);
    if (any_user.stiffness > 0.0 && std::isfinite(any_user.stiffness)) {
      wall.basis = SafeWall::Basis::any_user;
      wall.limit = any_user.stiffness;
    }
  }
  if (wall.basis == SafeWall::Basis::device && device.has_bodies()) {
    wall.remarks.push_back(note({.code = FindingCode::no_any_user_limit_to_share}));
  }
  take_lower_bounds(held, least, options, wall);
  const double share = options.safety_factor * wall.uncertainty_share;
  wall.stiffness = share * wall.limit;
  if (!own && wall.stiffness > 0.0) {
    wall.damping_limit = damping_limit(holders, wall);
    if (wall.trust.refused()) return;
    wall.damping = share * *wall.damping_limit;
    if (wall.absolute_stability_interval) lower_damping(device, options.any_user_draws, filter, wall);
  }
  if (!(wall.stiffness > 0.0)) {
    wall.trust.refuse({.code = FindingCode::uncertainty_leaves_no_wall});
    return;
  }
  check_wall(holders, options, wall);
}

}  // namespace

std::optional<OptionProblem> find_problem(const SafeWallOptions& options) {
  if (!(options.safety_factor > 0.0 && options.safety_factor < 1.0)) {
    return option_problem("safety_factor",
                          {.code = ProblemCode::no_fraction, .evidence = {{"value", options.safety_factor}}});
  }
  for (const auto& [member, draws] : {std::pair{"draws", options.draws}, {"any_user_draws", options.any_user_draws}}) {
    if (draws == 0) return option_problem(member, {.code = ProblemCode::none_asked});
  }
  return std::nullopt;
}

SafeWall safe_wall(const Device& device, const SafeWallOptions& options) {
  require_known_structure(device);
  if (!knows_all_users(device)) require_one_rate(device);
  require_valid(find_problem(options));
  SafeWall wall;
  wall.trust = trust_of(device);
  if (wall.trust.refused()) return refused(std::move(wall));
  try {
    choose(device, options, wall);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    wall.trust.refuse({.code = FindingCode::not_converged, .subjects = {{"reason", error.what()}}});
  }
  if (wall.trust.refused()) return refused(std::move(wall));
  return wall;
}

}  // namespace zwidth
