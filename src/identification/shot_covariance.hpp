#pragma once

#include <Eigen/Core>
#include <vector>

#include "identification/identifiability.hpp"
#include "identification/shot_fit.hpp"

namespace zwidth::internal {

/// What the records determine of x, and how well.
struct ShotCovariance {
  Identifiability known;       ///< of the coordinates and the constant forces
  Eigen::MatrixXd covariance;  ///< of x; 0 for what does not show
  /// Not held; or held where others follow it wholly, as one of two dampings of which the sum shows: its covariance with them
  /// counts then.
  std::vector<bool> varies;
  /// Of what is held: how clearly the residuals ask for more of it, all others free to follow, in standard deviations.
  Eigen::VectorXd pull;
  /// Of what is held: one such deviation, in x.
  Eigen::VectorXd pulled_deviation;
  /// Of what varies: how far Newton's step would still go from here. Nothing where a search ended for its slopes; a misfit
  /// with kinks ends it elsewhere.
  Eigen::VectorXd step;
};

/// With the states eliminated: x's slopes less what the shots' own states explain of them; then
/// covariance_with_correlated_residuals(), no variance less than that of the scores' sums over stretches of the record,
/// nor than for white noise of deviation 1 (the encoder's floor). Along the directions that do not show, known_beforehand
/// takes its place.
///
/// What is held (at 0, its bound) counts as known beside the others, but where they follow it wholly; its own variance is that
/// with the others known.
[[nodiscard]] ShotCovariance shot_covariance(const ShotSlopes& slopes, const std::vector<bool>& held);

/// Each variance at least that of the other; correlations stay.
void widen(Eigen::MatrixXd& covariance, const Eigen::MatrixXd& least);

}  // namespace zwidth::internal
