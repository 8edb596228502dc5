#include "design/synthesis/two_rate_limits.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "design/synthesis/known_holders.hpp"
#include "design/synthesis/margin_wall.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth::internal {
namespace {

constexpr double off_every_limit = 1e-6;
constexpr double rounding_of_margins = 1e-9;
constexpr double same_margin = 1e-4;  // relative, of a margin that is the one that bounds

LoopMargins margins_of(const FilteredPlant& plant, double stiffness) {
  Wall spring;
  spring.stiffness = stiffness;
  return loop_margins(plant, spring);
}

}  // namespace

void TwoRateLimits::search(bool quickly) {
  is_quick_ = quickly && has_users_;
  if (is_quick_ && !users_) users_.emplace(device_);
}

double TwoRateLimits::limit(VirtualDamper damper) const {
  tell(options_.progress, 0.0);
  const Device walled = with_wall(device_, 0.0, damper);
  if (damper.damping == 0.0 && has_users_) return any_user_limit(walled, options_.progress)->stiffness;
  const CriticalStiffness nobody = unguarded_stiffness(device_without_user(walled));
  if (is_quick_) return std::min(nobody.stiffness, users_->limit_seen(damper));
  if (has_users_) return two_rate_absolute_stability(walled, nobody)->stiffness;
  return nobody.stiffness;
}

WallLimits::Stiffest TwoRateLimits::stiffest(VirtualDamper damper, const WallLimits::Stiffest& at_most) const {
  WallLimits::Stiffest least = at_most;
  const auto take = [&least](double stiffness, WallBound bound) {
    if (stiffness < least.stiffness) least = {stiffness, bound};
  };
  const double gain = options_.gain_margin;
  const WallBound by_gain = has_users_ ? WallBound::any_user : WallBound::gain_margin;
  take(limit(damper) / gain, by_gain);
  for (const double factor : {std::sqrt(gain), gain}) {
    if (damper.damping == 0.0 || least.stiffness == 0.0) break;
    take(limit({factor * damper.damping, damper.velocity_filter_hz}) / factor, by_gain);
  }
  const double resolution = device_.parameters().sensor.resolution;
  if (options_.quantisation_force && resolution > 0.0) {
    const double period = damper_timing(device_.loop()).sampling_period;
    const ForcePerCountRates rates =
        force_per_count_rates(with_wall(device_, 0.0, damper).parameters().wall, period, resolution);
    take(std::max(0.0, *options_.quantisation_force - damper.damping * rates.per_damping) / rates.per_stiffness,
         WallBound::quantisation_force);
  }
  if (!(least.stiffness > 0.0) || !std::isfinite(least.stiffness)) return least;
  least.stiffness *= 1.0 - off_every_limit;
  keep_margins(damper, least);
  return least;
}

bool TwoRateLimits::keeps(double stiffness, VirtualDamper damper) const {
  const double gain = options_.gain_margin;
  for (const double factor : {1.0, std::sqrt(gain), gain}) {
    const double grown = factor == 1.0 ? gain : factor;
    if (grown * stiffness >= limit({factor * damper.damping, damper.velocity_filter_hz}) * (1.0 + rounding_of_margins))
      return false;
  }
  return std::ranges::all_of(plants(damper), [&](const FilteredPlant& plant) { return loop_keeps(plant, stiffness); });
}

// As the spring sees them: with nobody, and with the file's user.
std::vector<FilteredPlant> TwoRateLimits::plants(VirtualDamper damper) const {
  std::vector<FilteredPlant> seen;
  for (const Device& each : known_holders(with_wall(device_, 0.0, damper))) {
    seen.push_back(TwoRateDevice(each, damper.damping).seen_by_spring());
  }
  return seen;
}

bool TwoRateLimits::loop_keeps(const FilteredPlant& plant, double stiffness) const {
  const LoopMargins has = margins_of(plant, stiffness);
  return has.stable && has.gain_margin.value_or(infinity) >= options_.gain_margin * (1.0 - rounding_of_margins) &&
         has.lower_gain_margin.value_or(0.0) * options_.gain_margin <= 1.0 + rounding_of_margins &&
         has.phase_margin.value_or(std::numbers::pi) >= options_.phase_margin * (1.0 - rounding_of_margins);
}

void TwoRateLimits::keep_margins(VirtualDamper damper, WallLimits::Stiffest& least) const {
  const std::vector<FilteredPlant> seen = plants(damper);
  const auto all_keep = [&] {
    return std::ranges::all_of(seen, [&](const FilteredPlant& plant) { return loop_keeps(plant, least.stiffness); });
  };
  if (all_keep()) return;
  const RequiredMargins margins{options_.gain_margin, options_.phase_margin, false};
  for (const FilteredPlant& plant : seen) {
    const double kept = stiffest_wall(plant, {}, margins, {.at_most = least.stiffness}, options_.progress);
    least.stiffness = std::min(least.stiffness, kept * (1.0 - off_every_limit));
  }
  const bool phase =
      least.stiffness == 0.0 || std::ranges::any_of(seen, [&](const FilteredPlant& plant) {
        const LoopMargins has = margins_of(plant, least.stiffness);
        return has.phase_margin && *has.phase_margin <= options_.phase_margin * (1.0 + same_margin) + off_every_limit;
      });
  least.bound = phase ? WallBound::phase_margin : WallBound::gain_margin;
  if (least.stiffness > 0.0 && !all_keep()) least.stiffness = 0.0;
}

}  // namespace zwidth::internal
