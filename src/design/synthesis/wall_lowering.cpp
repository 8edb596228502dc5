#include "design/synthesis/wall_lowering.hpp"

namespace zwidth::internal {
namespace {

constexpr int rounds_of_lowering = 3;  // where uncertainty and modal shifts lower it by turns

}  // namespace

WorstCaseScreening& WallLowering::draws(const std::optional<WallFilter>& notch) {
  auto& end = draws_[notch ? 1 : 0];
  if (!end) end = std::make_unique<WorstCaseScreening>(drawn(device_, options_), notch, draws_that_may_fail, options_);
  return *end;
}

WorstCaseScreening& WallLowering::modal_shifts(const std::optional<WallFilter>& notch) {
  auto& end = modal_shifts_[notch ? 1 : 0];
  if (!end)
    end = std::make_unique<WorstCaseScreening>(with_modal_shifts(device_, options_.modal_frequency_uncertainty), notch,
                                               0.0, options_);
  return *end;
}

WallLowering::Kept WallLowering::lowered(double stiffness, VirtualDamper damper, const std::optional<WallFilter>& notch,
                                         WallGoal goal) {
  const auto& uncertainty = device_.parameters().uncertainty;
  const bool uncertain = uncertainty && !uncertainty->parameters.empty();
  const bool modes_are_uncertain = options_.modal_frequency_uncertainty > 0.0;
  Kept kept{stiffness, damper, {}, {}};
  const auto lower = [&](WorstCaseScreening& end, WallBound by) {
    const WorstCaseScreening::Kept left = end.lowered(kept.stiffness, kept.damper, goal);
    const bool changed = left.stiffness < kept.stiffness || left.damper.damping < kept.damper.damping;
    if (changed) kept = {left.stiffness, left.damper, by, {}};
    return changed;
  };
  bool changed = uncertain || modes_are_uncertain;
  for (int round = 0; round < rounds_of_lowering && changed; ++round) {
    changed = false;
    if (uncertain && lower(draws(notch), WallBound::uncertainty)) changed = modes_are_uncertain;
    if (!(kept.stiffness > 0.0)) {
      kept.why_none =
          Finding{.code = FindingCode::uncertainty_leaves_no_margins, .evidence = {{"threshold", draws_that_may_fail}}};
      return kept;
    }
    if (modes_are_uncertain && lower(modal_shifts(notch), WallBound::modal_frequency_uncertainty)) changed = uncertain;
    if (changed || !(kept.stiffness > 0.0)) {
      if (kept.stiffness > 0.0 && round + 1 < rounds_of_lowering) continue;
      return {0.0, {}, {}, Finding{.code = FindingCode::drift_leaves_no_wall}};
    }
  }
  if (modes_are_uncertain && notch && !modal_shifts(notch).has_no_lower_limit_than(modal_shifts({}), kept.damper)) {
    return {0.0, {}, {}, Finding{.code = FindingCode::notch_lowers_any_user_limit}};
  }
  return kept;
}

}  // namespace zwidth::internal
