#pragma once

#include <optional>
#include <vector>

#include "design/synthesis/wall_limits.hpp"
#include "infinity.hpp"
#include "stability/users/any_user_limit.hpp"
#include "stability/users/two_rate_users.hpp"
#include "zwidth/design/wall_recommendation.hpp"

namespace zwidth::internal {

// What bounds a wall of a device whose damper runs faster in a loop of its own, whatever its damper: WallLimits of two rates.
class TwoRateLimits {
 public:
  // `device`: of a loop that knows_all_users(). Both must outlive this.
  TwoRateLimits(const Device& device, const RecommendationOptions& options)
      : device_(device), options_(options), has_users_(can_be_held(device)) {}

  [[nodiscard]] bool has_users() const { return has_users_; }

  // Whether a search looks: each limit with any user is then as TwoRateUsers::limit_on_grid().
  void search(bool quickly);

  // The end of the stable stiffnesses from 0 on, with every user (where there is such a limit).
  [[nodiscard]] double limit(VirtualDamper damper) const;

  // The stiffest wall with this damper that keeps everything asked, no stiffer than one that something else bounds.
  [[nodiscard]] BoundedStiffness stiffest(VirtualDamper damper,
                                          const BoundedStiffness& at_most = {infinity, WallBound::none}) const;

  // Whether the spring's loop keeps its margins with nobody and with the file's user, and every user the gain margin.
  [[nodiscard]] bool keeps(double stiffness, VirtualDamper damper) const;

 private:
  // As the spring sees them behind this damper: with nobody, and with the file's user.
  [[nodiscard]] std::vector<FilteredPlant> plants(VirtualDamper damper) const;

  const Device& device_;
  const RecommendationOptions& options_;
  bool has_users_;
  bool is_quick_ = false;
  std::optional<TwoRateUsers> users_;
};

}  // namespace zwidth::internal
