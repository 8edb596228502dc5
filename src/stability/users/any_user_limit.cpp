#include "stability/users/any_user_limit.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "model/rate_ratio.hpp"
#include "stability/users/two_rate_users.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/tip_motion.hpp"

namespace zwidth::internal {
namespace {

constexpr double whole_within = 1e-6;  // periods of the damper, of the difference of the delays

bool is_whole(double periods) { return periods == std::round(periods); }

// A mechanism's tip is grasped in every direction; what that does is known of one rate alone.
bool is_held_along_the_wall(const Device& device) {
  return !has_damper_loop(device.loop()) || !is_of_mechanism(device);
}

}  // namespace

std::optional<double> damper_periods_later(const Loop& loop) {
  const auto [period, delay] = damper_timing(loop);
  if (rate_ratio(loop.sampling_period, period) < 1.0) return std::nullopt;
  const double later = (loop.delay - delay) / period;
  const double whole = std::round(later);
  return std::abs(later - whole) <= whole_within ? whole : later;
}

bool bounds_all_users(const Loop& loop) { return damper_periods_later(loop).has_value(); }

bool knows_all_users(const Loop& loop) {
  const std::optional<double> later = damper_periods_later(loop);
  return later && is_whole(*later);
}

bool bounds_all_users(const Device& device) {
  return is_held_along_the_wall(device) && bounds_all_users(device.loop());
}

bool knows_all_users(const Device& device) { return is_held_along_the_wall(device) && knows_all_users(device.loop()); }

std::optional<AbsoluteStabilityLimit> any_user_limit(const Device& device, const Progress& progress) {
  if (!has_damper_loop(device.loop())) return absolute_stability_limit(device, virtual_damper(device), progress);
  if (device.parameters().wall.damping == 0.0) return any_user_limit(with_one_rate(device), progress);
  if (!knows_all_users(device)) return std::nullopt;
  tell(progress, 0.0);
  const CriticalStiffness nobody = critical_stiffness(device_without_user(device));
  if (nobody.trust.refused()) {
    AbsoluteStabilityLimit refused;
    refused.stiffness = std::numeric_limits<double>::quiet_NaN();
    refused.trust = nobody.trust;
    return refused;
  }
  return two_rate_absolute_stability(device, nobody);
}

AbsoluteStabilityLimit known_any_user_limit(const Device& device, const Progress& progress) {
  std::optional<AbsoluteStabilityLimit> limit = any_user_limit(device, progress);
  if (!limit) require_one_rate(device);
  return *std::move(limit);
}

Remark any_user_limit_scanned(const Loop& loop) {
  Finding finding{.code = FindingCode::any_user_limit_scanned};
  if (!knows_all_users(loop)) {
    finding.subjects = {{"what", "bound"}};
    finding.key = "loop.damper.delay";
  }
  return note(std::move(finding));
}

}  // namespace zwidth::internal
