#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "design/synthesis/bounded_stiffness.hpp"
#include "stability/users/absolute_stability_search.hpp"
#include "zwidth/design/wall_recommendation.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// The device with this wall; without its uncertainty.
[[nodiscard]] Device with_wall(const Device& device, double stiffness, VirtualDamper damper);

// The device as it is with one more filter in its wall; without its uncertainty.
[[nodiscard]] Device with_filter(const Device& device, const WallFilter& filter);

// Of two limits with any user: lower by more than their rounding.
[[nodiscard]] inline bool is_lower(double limit, double than) { return limit < than * (1.0 - 1e-9); }

// The limit over all passive users can be computed.
[[nodiscard]] bool can_be_held(const Device& device);

// What bounds a wall, exactly, whatever its damper; the device's wall.filters are closed.
class WallLimits {
 public:
  WallLimits(const Device& device, const RecommendationOptions& options);

  // The stiffest wall with this damper that keeps everything asked, for the goal asked or another.
  [[nodiscard]] BoundedStiffness stiffest(VirtualDamper damper) { return stiffest(damper, options_.goal); }
  [[nodiscard]] BoundedStiffness stiffest(VirtualDamper damper, WallGoal goal);

  // Whether the loop keeps its margins with nobody and with the file's user, and every user the gain margin.
  [[nodiscard]] bool keeps(double stiffness, VirtualDamper damper);

  // The end of the stable stiffnesses from 0 on, with every user (where there is such a limit); 0 where it is not known.
  [[nodiscard]] double limit(VirtualDamper damper);

  // Whether a limit that was asked for is not known.
  [[nodiscard]] bool misses_a_limit() const { return misses_a_limit_; }

  // Least damping ratio of the contact (contact_damping_ratio()); 1 where there is none.
  [[nodiscard]] double contact_damping(double stiffness, VirtualDamper damper) const;

  [[nodiscard]] bool has_users() const { return users_ != nullptr; }
  [[nodiscard]] const Device& device() const { return device_; }

 private:
  [[nodiscard]] BoundedStiffness critically_damped(double at_most, VirtualDamper damper) const;

  Device device_;
  RecommendationOptions options_;
  std::vector<FilteredPlant> plants_;  // with the file's user, and with nobody holding where there is one
  DiscreteStateSpace system_;
  std::unique_ptr<AbsoluteStabilitySearch> users_;
  bool misses_a_limit_ = false;
};

}  // namespace zwidth::internal
