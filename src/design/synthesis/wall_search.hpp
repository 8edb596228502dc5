#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "design/region/real_poles.hpp"
#include "design/synthesis/margin_wall.hpp"
#include "design/synthesis/wall_limits.hpp"
#include "zwidth/design/wall_recommendation.hpp"

namespace zwidth::internal {

// Searches the damper that makes a wall best at its goal, on a grid of frequencies: what it finds WallLimits recomputes.
class WallSearch {
 public:
  // `limits` and `options` must outlive the search.
  WallSearch(const WallLimits& limits, const RecommendationOptions& options);
  // The same device with one more filter in its wall, which `limits` have too.
  WallSearch(const WallSearch& without, const WallLimits& limits, const WallFilter& filter);

  [[nodiscard]] const LoopGrid& grid() const { return *grid_; }

  struct Found {
    VirtualDamper damper;
    double value = 0.0;  // of the goal, as far as the grid tells; 0: no wall
  };
  // The best B behind this velocity filter.
  [[nodiscard]] Found best(double velocity_filter_hz, WallGoal goal) const;

  // The stiffest wall with this damper, as far as the grid tells.
  [[nodiscard]] double stiffest(VirtualDamper damper, WallGoal goal) const;

  // The best velocity filter around that of `start`, with its best B.
  [[nodiscard]] Found best_near(const Found& start, WallGoal goal) const;

  // Velocity filters worth trying: none, and from fast ones down to twice the frequency at which the device oscillates, or
  // to a hundredth of the sampling rate.
  [[nodiscard]] std::vector<double> velocity_filters() const;

  // What the goal is about.
  [[nodiscard]] static double value_of(WallGoal goal, double stiffness, double damping);

 private:
  struct Filtered {  // what one velocity filter leaves
    double cutoff_hz = 0.0;
    LoopGrid::Response unit_damper;
    ForcePerCountRates rates;
    std::optional<RealPoles> real_poles;  // where the contact is not to swing
  };
  WallSearch(const WallLimits& limits, const RecommendationOptions& options, std::shared_ptr<const LoopGrid> grid,
             LoopGrid::Response factor);

  [[nodiscard]] Filtered filtered(double velocity_filter_hz, WallGoal goal) const;
  [[nodiscard]] double value(const Filtered& filtered, double damping, WallGoal goal, double enough) const;
  [[nodiscard]] double most_damping(const Filtered& filtered) const;
  [[nodiscard]] double damped_contact(double at_most, const Filtered& filtered, double damping, double enough) const;

  const WallLimits& limits_;
  const RecommendationOptions& options_;
  double period_;
  FilteredPlant plant_;
  std::shared_ptr<const LoopGrid> grid_;
  LoopGrid::Response factor_;        // of the filter that the grid's device has not
  double critical_frequency_ = 0.0;  // rad/s, without a damper; 0: it does not oscillate
  double critical_stiffness_ = 0.0;
};

}  // namespace zwidth::internal
