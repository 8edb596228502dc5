#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "design/wall_limits.hpp"
#include "design/wall_search.hpp"
#include "zwidth/design/wall_recommendation.hpp"

namespace zwidth::internal {

// What an uncertain device leaves of a wall: devices drawn from the uncertainty, each with its own limits.
class LowerEnd {
 public:
  // With `notch` behind the filters of the device's wall. The device must have uncertain parameters; `options` must
  // outlive this.
  LowerEnd(const Device& device, const std::optional<WallFilter>& notch, const RecommendationOptions& options);

  struct Kept {
    double stiffness = 0.0;  // 0: none
    VirtualDamper damper;
  };
  // The best wall for the goal, no stiffer and no more damped than this one, for which all but 2.5 % of the draws keep
  // what is asked: found on grids of frequencies, confirmed exactly.
  [[nodiscard]] Kept lowered(double stiffness, VirtualDamper damper, WallGoal goal);

 private:
  struct Draw {
    std::unique_ptr<WallLimits> limits;
    std::unique_ptr<WallSearch> search;
  };
  [[nodiscard]] bool most_keep(double stiffness, VirtualDamper damper) const;
  [[nodiscard]] double lower_limit(VirtualDamper damper, WallGoal goal) const;

  std::vector<Draw> draws_;
};

}  // namespace zwidth::internal
