#include "zwidth/stability/absolute_stability.hpp"

#include <limits>
#include <utility>

#include "stability/users/absolute_stability_search.hpp"
#include "stability/users/any_grasp.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"

namespace zwidth {
using namespace internal;
namespace {

AbsoluteStabilityLimit of_mechanism(const Device& device, VirtualDamper damper) {
  DeviceParameters alone = device_without_user(device).parameters();
  alone.wall.damping = damper.damping;
  alone.wall.velocity_filter_hz = damper.velocity_filter_hz;
  const Device free(std::move(alone));
  auto limit = any_grasp_absolute_stability(free, damper, critical_stiffness(free));
  if (limit) return *std::move(limit);
  if (has_damper_loop(free.loop()) && damper.damping > 0.0) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::one_direction_alone});
  }
  AbsoluteStabilityLimit refused;
  refused.stiffness = std::numeric_limits<double>::quiet_NaN();
  refused.trust.refuse({.code = FindingCode::any_grasp_not_known});
  return refused;
}

}  // namespace

AbsoluteStabilityLimit absolute_stability_limit(const Device& device, VirtualDamper damper, const Progress& progress) {
  if (is_grasped_in_many_directions(device)) return of_mechanism(device, damper);
  return AbsoluteStabilitySearch(device, progress).limit(damper, progress);
}

}  // namespace zwidth
