#include "design/synthesis/absolute_stability_check.hpp"

#include "design/synthesis/wall_limits.hpp"
#include "stability/users/any_user_limit.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/critical_damping.hpp"

namespace zwidth::internal {
namespace {

constexpr double same_for_users = 1e-9;  // relative, of two limits that are the same

AbsoluteStabilityCheck::Limit of_stiffness(const AbsoluteStabilityLimit& limit) {
  return {limit.stiffness, limit.frequency, limit.truncation, limit.trust};
}

/// What `limit` gives; absent where it is not known, not found or refused.
template <typename Limit>
std::optional<AbsoluteStabilityCheck::Limit> found(const Limit& limit) {
  try {
    std::optional<AbsoluteStabilityCheck::Limit> result = limit();
    if (result && result->trust.refused()) return std::nullopt;
    return result;
  } catch (const Error& error) {
    if (error.code() == ErrorCode::did_not_converge) return std::nullopt;
    throw;
  }
}

}  // namespace

std::optional<AbsoluteStabilityCheck::Limit> absolute_stability_limit_of(const Device& device, WallNumber number,
                                                                         const Progress& progress) {
  if (number == WallNumber::stiffness) {
    const auto limit = any_user_limit(device, progress);
    return limit ? std::optional(of_stiffness(*limit)) : std::nullopt;
  }
  const AbsoluteStabilityDamping limit = absolute_stability_damping(device, progress);
  return AbsoluteStabilityCheck::Limit{limit.damping, limit.frequency, limit.truncation, limit.trust};
}

AbsoluteStabilityCheck::AbsoluteStabilityCheck(const Device& device, WallNumber number, const Progress& progress)
    : number_(number), progress_(progress) {
  if (can_be_held(device)) now_ = found([&] { return absolute_stability_limit_of(device, number_, progress_); });
}

AbsoluteStabilityCheck::Judgement AbsoluteStabilityCheck::judged(const std::optional<Limit>& limit) const {
  if (!limit) return {std::nullopt, false};  // what is not known may be lower
  // What was taken off the limit for certainty lowers nothing.
  const double most = limit->value * (1.0 + limit->truncation);
  return {limit->value, most >= now_->value * (1.0 - same_for_users)};
}

AbsoluteStabilityCheck::Judgement AbsoluteStabilityCheck::of(const Device& changed) const {
  if (!now_) return {};
  return judged(found([&] { return absolute_stability_limit_of(changed, number_, progress_); }));
}

AbsoluteStabilityCheck::Judgement AbsoluteStabilityCheck::of(const Device& changed,
                                                             AbsoluteStabilitySearch& users) const {
  if (!now_) return {};
  return judged(found([&] { return std::optional(of_stiffness(users.limit(virtual_damper(changed), progress_))); }));
}

}  // namespace zwidth::internal
