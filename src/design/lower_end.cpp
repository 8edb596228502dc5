#include "design/lower_end.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "stability/device_draws.hpp"
#include "staged_progress.hpp"

namespace zwidth::internal {
namespace {

constexpr std::uint64_t seed = 1;
constexpr double tail = 0.025;
constexpr int shares_of_damping = 10;
constexpr double softer = 0.97;
constexpr int most_softer = 40;

}  // namespace

LowerEnd::LowerEnd(const Device& device, const std::optional<WallFilter>& notch, const RecommendationOptions& options) {
  DeviceDraws drawn(device, seed);
  for (std::size_t i = 0; i < options.draws; ++i) {
    tell(options.progress, static_cast<double>(i) / static_cast<double>(options.draws));
    const Device each = drawn.next();
    Draw draw{std::make_unique<WallLimits>(notch ? with_filter(each, *notch) : each, options), nullptr};
    draw.search = std::make_unique<WallSearch>(*draw.limits, options);
    draws_.push_back(std::move(draw));
  }
}

/// On the grids.
double LowerEnd::lower_limit(VirtualDamper damper, WallGoal goal) const {
  std::vector<double> stiffnesses;
  for (const Draw& each : draws_) stiffnesses.push_back(each.search->stiffest(damper, goal));
  const auto at = stiffnesses.begin() + static_cast<std::ptrdiff_t>(tail * static_cast<double>(stiffnesses.size()));
  std::nth_element(stiffnesses.begin(), at, stiffnesses.end());
  return *at;
}

bool LowerEnd::most_keep(double stiffness, VirtualDamper damper) const {
  const auto may_fail = static_cast<std::size_t>(tail * static_cast<double>(draws_.size()));
  std::size_t failed = 0;
  for (const Draw& each : draws_) {
    if (!each.limits->keeps(stiffness, damper) && ++failed > may_fail) return false;
  }
  return true;
}

LowerEnd::Kept LowerEnd::lowered(double stiffness, VirtualDamper damper, WallGoal goal) {
  if (most_keep(stiffness, damper)) return {stiffness, damper};
  Kept best;
  double value = 0.0;
  for (int i = shares_of_damping; i >= 0; --i) {
    const VirtualDamper less{damper.damping * i / shares_of_damping, damper.velocity_filter_hz};
    const double limit = std::min(stiffness, lower_limit(less, goal));
    if (WallSearch::value_of(goal, limit, less.damping) > value) {
      value = WallSearch::value_of(goal, limit, less.damping);
      best = {limit, less};
    }
  }
  for (int i = 0; i < most_softer && best.stiffness > 0.0; ++i, best.stiffness *= softer) {
    if (most_keep(best.stiffness, best.damper)) return best;
  }
  return {};
}

}  // namespace zwidth::internal
