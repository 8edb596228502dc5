#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "identification/shot_fit.hpp"
#include "identification/shot_model.hpp"
#include "identification/shot_noise.hpp"
#include "identification/shot_search.hpp"

namespace zwidth::internal {

/// What is followed, and how.
struct Follower {
  const ShotModel& model;
  const ShotSearch& search;
  const std::vector<Shot>& shots;
};

/// With one element of x, the friction, that stays; at first under `noise`, since what the rest has yet to follow would pass
/// for drift. Nothing where no such device can be followed.
[[nodiscard]] std::optional<FittedShots> with_held_friction(const Follower& follower, ShotFit start,
                                                            Eigen::Index friction, double value,
                                                            const std::vector<ShotNoise>& noise);

/// A gain above this: it explains about as much as the linear device.
inline constexpr double as_much = -4.0;

/// With the friction free, and what the linear device leaves.
struct FrictionFit {
  FittedShots best;
  double badness;
  double linear_badness;
  [[nodiscard]] double gain() const { return linear_badness - badness; }
};

/// The least bad of the searches from each start. Of long shots some end in side minima without friction, of short ones others.
[[nodiscard]] std::optional<FittedShots> best_from(const Follower& follower, const std::vector<SearchStart>& starts,
                                                   const std::vector<Shot>& short_shots);

/// The search goes on from where friction was held.
[[nodiscard]] std::optional<FrictionFit> with_free_friction(const Follower& follower, const FittedShots& held,
                                                            double linear_badness);

/// `best` beside the device without friction, its element `friction` of x 0; the search goes on from there where `best` explains
/// clearly less: it is a side minimum. Nothing where the linear device cannot be followed.
[[nodiscard]] std::optional<FrictionFit> beside_linear(const Follower& follower, FittedShots best,
                                                       const Eigen::VectorXd& linear, Eigen::Index friction);

}  // namespace zwidth::internal
