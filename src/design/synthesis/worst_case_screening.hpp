#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "design/synthesis/wall_limits.hpp"
#include "design/synthesis/wall_search.hpp"
#include "zwidth/design/wall_recommendation.hpp"

namespace zwidth::internal {

// `options.draws` devices drawn from the uncertainty of one that has uncertain parameters.
[[nodiscard]] std::vector<Device> drawn(const Device& device, const RecommendationOptions& options);

// The share of them that a wall may fail: the lower end of an interval of 95 %.
inline constexpr double draws_that_may_fail = 0.025;

// The device with its modes at every modal shift that a wall is held against, see with_modal_shift(); the furthest first.
inline constexpr std::size_t modal_shifts_held = 41;
[[nodiscard]] std::vector<Device> with_modal_shifts(const Device& device, double uncertainty);

// What a device leaves of a wall that may be any of several: each with its own limits, looked at side by side.
class WorstCaseScreening {
 public:
  // With `notch` behind the filters of each wall; all but this share of them keep what is asked. The progress of `options`
  // is told by one thread at a time.
  WorstCaseScreening(const std::vector<Device>& devices, const std::optional<WallFilter>& notch, double may_fail,
                     const RecommendationOptions& options);

  struct Kept {
    double stiffness = 0.0;  // 0: none
    VirtualDamper damper;
  };
  // The best wall for the goal, no stiffer and no more damped than this one, for which enough of the devices keep what is
  // asked: found on grids of frequencies, confirmed exactly.
  [[nodiscard]] Kept lowered(double stiffness, VirtualDamper damper, WallGoal goal);

  // Whether no device's limit with any user is lower than that of the same one of the others.
  [[nodiscard]] bool has_no_lower_limit_than(const WorstCaseScreening& others, VirtualDamper damper) const;

 private:
  struct Each {
    std::unique_ptr<WallLimits> limits;
    std::unique_ptr<WallSearch> search;  // once it is needed
  };
  // Asks the devices in their order, and no further than is needed.
  template <typename Keeps>
  [[nodiscard]] bool enough_keep(const Keeps& keeps);
  [[nodiscard]] bool most_keep(double stiffness, VirtualDamper damper);
  [[nodiscard]] double lower_limit(VirtualDamper damper, WallGoal goal, double enough);

  std::mutex told_;
  RecommendationOptions options_;
  std::size_t may_fail_ = 0;
  std::vector<Each> devices_;
};

}  // namespace zwidth::internal
