#include "design/synthesis/limit_along_parameter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "design/sensitivities/number_limit.hpp"
#include "design/sensitivities/two_rate_sensitivity.hpp"
#include "stability/limit/gain_crossings.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "stability/loop/damper_response.hpp"
#include "stability/users/any_user_limit.hpp"
#include "stability/users/disc_stiffness.hpp"
#include "stability/users/user_discs.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/critical_damping.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t most_angles = 4;
constexpr std::array beside{1.0, 0.9, 1.1};  // times an angle at which users have set the limit
constexpr double low_angle = 1e-2;           // where the limit is reached towards zero frequency
constexpr double bound_certain = 1e-6;       // relative, of a bound

}  // namespace

std::optional<LimitAlongParameter::Limit> LimitAlongParameter::at(double value, const Interest& interest) {
  DeviceParameters moved = device_.parameters();
  moved.uncertainty.reset();
  set_with_ratio(moved, parameter_.key, value);
  if (find_problem(moved)) return std::nullopt;
  const Device device(std::move(moved));
  try {
    if (number_ == WallNumber::damping) return of_damper(device, interest);
    if (has_damper_loop(device.loop())) return of_two_loops(device, interest);
    Limit limit{stiffness_limit(filtered_plant(device), virtual_damper(device), interest.most), false};
    if (goal_ == StiffnessGoal::critical_stiffness) return limit;
    limit.is_bound = limit.stiffness < interest.enough * (1.0 - bound_certain);
    if (!limit.is_bound) {
      const std::optional<double> any_user = of_any_user(device, interest.enough, limit);
      if (!any_user) return std::nullopt;
      limit.stiffness = std::min(limit.stiffness, *any_user);
    }
    return limit;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    if (has_damper_loop(device.loop())) refused_at_ = error.what();
    return std::nullopt;
  }
}

bool LimitAlongParameter::is_known() const {
  using Kind = DesignParameter::Kind;
  if (goal_ != StiffnessGoal::absolute_stability_limit || number_ == WallNumber::damping) return true;
  if (!has_damper_loop(device_.loop())) return true;
  if (parameter_.kind != Kind::delay && parameter_.kind != Kind::sampling_period) return true;
  constexpr double beside_whole = 0.137;  // of the damper's period, or of the period that moves
  const bool is_delay = parameter_.kind == Kind::delay;
  const double unit = is_delay ? damper_timing(device_.loop()).sampling_period : parameter_.value;
  DeviceParameters moved = device_.parameters();
  set_with_ratio(moved, parameter_.key, parameter_.value + beside_whole * unit);
  return knows_all_users(moved.loop);
}

LimitAlongParameter::Limit LimitAlongParameter::of_damper(const Device& device, const Interest& interest) const {
  const NumberLimit own = number_limit(device, number_);
  if (own.trust.refused()) throw Error(ErrorCode::did_not_converge, own.trust.reasons.front());
  Limit limit{std::min(own.value, interest.most), false};
  if (goal_ == StiffnessGoal::critical_stiffness) return limit;
  limit.is_bound = limit.stiffness < interest.enough * (1.0 - bound_certain);
  if (limit.is_bound) return limit;
  const AbsoluteStabilityDamping any_user = absolute_stability_damping(device);
  if (any_user.trust.refused()) throw Error(ErrorCode::did_not_converge, any_user.trust.reasons.front());
  limit.stiffness = std::min(limit.stiffness, any_user.damping);
  return limit;
}

std::optional<LimitAlongParameter::Limit> LimitAlongParameter::of_two_loops(const Device& device,
                                                                            const Interest& interest) {
  const CriticalStiffness nobody = unguarded_stiffness(device);
  if (nobody.trust.refused()) {
    refused_at_ = nobody.trust.reasons.front();
    return std::nullopt;
  }
  Limit limit{std::min(nobody.stiffness, interest.most), false};
  if (goal_ == StiffnessGoal::critical_stiffness) return limit;
  limit.is_bound = limit.stiffness < interest.enough * (1.0 - bound_certain);
  if (limit.is_bound) return limit;
  const auto any_user = any_user_limit(device);
  if (any_user && any_user->trust.refused()) refused_at_ = any_user->trust.reasons.front();
  if (!any_user || any_user->trust.refused()) return std::nullopt;
  limit.stiffness = std::min(limit.stiffness, any_user->stiffness);
  return limit;
}

std::optional<double> LimitAlongParameter::of_any_user(const Device& device, double enough, Limit& limit) {
  const VirtualDamper damper = virtual_damper(device);
  const double period = device.loop().sampling_period;
  const bool is_of_damper = parameter_.kind == DesignParameter::Kind::wall_damping ||
                            parameter_.kind == DesignParameter::Kind::velocity_filter_hz;
  if (!is_of_damper && enough > 0.0 && !angles_.empty()) {
    const UserDiscs discs(device);
    for (std::size_t i = angles_.size(); i-- > 0;) {
      for (const double factor : beside) {
        const double frequency = std::min(angles_[i] * factor, std::numbers::pi) / period;
        const double bound = least_stiffness(discs.at(frequency), damper_response(damper, period, frequency));
        limit.is_bound = bound < enough * (1.0 - bound_certain);
        if (limit.is_bound) return bound;
      }
    }
  }
  if (!users_ || !is_of_damper) users_ = std::make_unique<AbsoluteStabilitySearch>(device);
  const AbsoluteStabilityLimit found = users_->limit(damper);
  if (found.trust.refused()) {
    refused_at_ = found.trust.reasons.front();
    return std::nullopt;
  }
  const double angle = found.frequency > 0.0 ? found.frequency * period : low_angle;
  if (std::ranges::find(angles_, angle) == angles_.end()) angles_.push_back(angle);
  if (angles_.size() > most_angles) angles_.erase(angles_.begin());
  return found.stiffness;
}

}  // namespace zwidth::internal
