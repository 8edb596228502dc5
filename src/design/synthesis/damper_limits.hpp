#pragma once

#include <utility>

#include "zwidth/design/wall_recommendation.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {

// What bounds a damper alone, K = 0, exactly.
class DamperLimits {
 public:
  // `device`: without its wall; its filters are closed.
  DamperLimits(Device device, RecommendationOptions options)
      : device_(std::move(device)), options_(std::move(options)) {}

  struct Strongest {
    double damping = 0.0;  // 0: none; infinite: nothing bounds it
    WallBound bound = WallBound::none;
  };
  // The largest B behind this velocity filter that keeps everything asked.
  [[nodiscard]] Strongest strongest(double velocity_filter_hz) const;

  // Whether the device as it is keeps its margins with this damper, and every user the gain margin.
  [[nodiscard]] bool keeps(VirtualDamper damper) const;

  // The same by a route that shares nothing with it: closed-loop poles by matrix exponential of the damper grown by the
  // gain margin, with nobody and with users on a grid of masses and springs. What contradicts is refused in `trust`.
  void check(VirtualDamper damper, Trust& trust) const;

  [[nodiscard]] const Device& device() const { return device_; }

 private:
  [[nodiscard]] bool keeps_phase(VirtualDamper damper) const;
  [[nodiscard]] double limit(double velocity_filter_hz, bool& of_users) const;

  Device device_;
  RecommendationOptions options_;
};

// recommend_wall() of WallGoal::damper, of a device that is not refused. `device`: without its wall.
[[nodiscard]] WallRecommendation recommend_damper(const Device& device, const RecommendationOptions& options);

}  // namespace zwidth::internal
