#include "design/wall_lowering.hpp"

namespace zwidth::internal {
namespace {

constexpr double tail_of_draws = 0.025;  // of the devices drawn, which may fail
constexpr int rounds_of_lowering = 3;    // where uncertainty and drift lower it by turns

}  // namespace

LowerEnd& WallLowering::draws(const std::optional<WallFilter>& notch) {
  auto& end = draws_[notch ? 1 : 0];
  if (!end) end = std::make_unique<LowerEnd>(drawn(device_, options_), notch, tail_of_draws, options_);
  return *end;
}

LowerEnd& WallLowering::drifts(const std::optional<WallFilter>& notch) {
  auto& end = drifts_[notch ? 1 : 0];
  if (!end) end = std::make_unique<LowerEnd>(with_drifts(device_, options_.drift), notch, 0.0, options_);
  return *end;
}

WallLowering::Kept WallLowering::lowered(double stiffness, VirtualDamper damper, const std::optional<WallFilter>& notch,
                                         WallGoal goal) {
  const auto& uncertainty = device_.parameters().uncertainty;
  const bool uncertain = uncertainty && !uncertainty->parameters.empty();
  const bool drifting = options_.drift > 0.0;
  Kept kept{stiffness, damper, {}, {}};
  const auto lower = [&](LowerEnd& end, WallBound by) {
    const LowerEnd::Kept left = end.lowered(kept.stiffness, kept.damper, goal);
    const bool changed = left.stiffness < kept.stiffness || left.damper.damping < kept.damper.damping;
    if (changed) kept = {left.stiffness, left.damper, by, {}};
    return changed;
  };
  bool changed = uncertain || drifting;
  for (int round = 0; round < rounds_of_lowering && changed; ++round) {
    changed = false;
    if (uncertain && lower(draws(notch), WallBound::uncertainty)) changed = drifting;
    if (!(kept.stiffness > 0.0)) {
      kept.why_none =
          Finding{.code = FindingCode::uncertainty_leaves_no_margins, .evidence = {{"threshold", tail_of_draws}}};
      return kept;
    }
    if (drifting && lower(drifts(notch), WallBound::drift)) changed = uncertain;
    if (changed || !(kept.stiffness > 0.0)) {
      if (kept.stiffness > 0.0 && round + 1 < rounds_of_lowering) continue;
      return {0.0, {}, {}, Finding{.code = FindingCode::drift_leaves_no_wall}};
    }
  }
  if (drifting && notch && !drifts(notch).has_no_lower_limit_than(drifts({}), kept.damper)) {
    return {0.0, {}, {}, Finding{.code = FindingCode::notch_lowers_any_user_limit}};
  }
  return kept;
}

}  // namespace zwidth::internal
