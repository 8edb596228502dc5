#include "design/any_user_judge.hpp"

#include "design/wall_limits.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

constexpr double rounding = 1e-9;  // relative, of two limits that are the same

/// What `limit` gives; absent where it is not found or refused.
template <typename Limit>
std::optional<AnyUserLimit> found(const Limit& limit) {
  try {
    AnyUserLimit result = limit();
    if (result.trust.refused()) return std::nullopt;
    return result;
  } catch (const Error& error) {
    if (error.code() == ErrorCode::did_not_converge) return std::nullopt;
    throw;
  }
}

}  // namespace

AnyUserJudge::AnyUserJudge(const Device& device, const Progress& progress) : progress_(progress) {
  if (!can_be_held(device)) return;
  now_ = found([&] { return any_user_limit(device, virtual_damper(device), progress_); });
}

AnyUserJudge::Judgement AnyUserJudge::judged(const std::optional<AnyUserLimit>& limit) const {
  if (!limit) return {};
  // What was taken off the limit for certainty lowers nothing.
  const double most = limit->stiffness * (1.0 + limit->truncation);
  return {limit->stiffness, most >= now_->stiffness * (1.0 - rounding)};
}

AnyUserJudge::Judgement AnyUserJudge::of(const Device& changed) const {
  if (!now_) return {};
  return judged(found([&] { return any_user_limit(changed, virtual_damper(changed), progress_); }));
}

AnyUserJudge::Judgement AnyUserJudge::of(const Device& changed, AnyUserSearch& users) const {
  if (!now_) return {};
  return judged(found([&] { return users.limit(virtual_damper(changed), progress_); }));
}

}  // namespace zwidth::internal
