#include "design/synthesis/two_rate_limits.hpp"

#include <algorithm>
#include <cmath>

#include "design/synthesis/known_holders.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth::internal {

void TwoRateLimits::search(bool quickly) {
  is_quick_ = quickly && has_users_;
  if (is_quick_ && !users_) users_.emplace(device_);
}

double TwoRateLimits::limit(VirtualDamper damper) const {
  tell(options_.progress, 0.0);
  const Device walled = with_wall(device_, 0.0, damper);
  if (damper.damping == 0.0 && has_users_) return any_user_limit(walled, options_.progress)->lower_bound();
  const CriticalStiffness nobody = unguarded_stiffness(device_without_user(walled));
  if (is_quick_) return std::min(nobody.stiffness, users_->limit_on_grid(damper));
  if (has_users_) return two_rate_absolute_stability(walled, nobody)->stiffness;
  return nobody.stiffness;
}

BoundedStiffness TwoRateLimits::stiffest(VirtualDamper damper, const BoundedStiffness& at_most) const {
  BoundedStiffness least = at_most;
  const auto limit_with = [this](VirtualDamper each) { return limit(each); };
  const WallBound by_gain = has_users_ ? WallBound::any_user : WallBound::gain_margin;
  bound_by_gain(limit_with, damper, options_.gain_margin, by_gain, least);
  bound_by_quantisation(device_, damper_timing(device_.loop()).sampling_period, damper, options_, least);
  if (!(least.stiffness > 0.0) || !std::isfinite(least.stiffness)) return least;
  least.stiffness *= 1.0 - off_every_limit;
  bound_by_margins(plants(damper), {}, options_, least);
  return least;
}

bool TwoRateLimits::keeps(double stiffness, VirtualDamper damper) const {
  const auto limit_with = [this](VirtualDamper each) { return limit(each); };
  return keeps_gain(limit_with, stiffness, damper, options_.gain_margin) &&
         keeps_margins(plants(damper), stiffness, {}, options_);
}

std::vector<FilteredPlant> TwoRateLimits::plants(VirtualDamper damper) const {
  std::vector<FilteredPlant> seen;
  for (const Device& each : known_holders(with_wall(device_, 0.0, damper))) {
    seen.push_back(TwoRateDevice(each, damper.damping).seen_by_spring());
  }
  return seen;
}

}  // namespace zwidth::internal
