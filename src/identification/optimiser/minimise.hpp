#pragma once

#include <Eigen/Core>
#include <optional>

#include "identification/optimiser/least_squares_problem.hpp"

namespace zwidth::internal {

struct MinimiseOptions {
  int most_steps = 40;
  double least_gain = 1e-3;  ///< of the log-likelihood that a step promises: below, the search is at rest
  double residuals = 0.0;  ///< so many; where they are larger than their noise, the gain is of the noise that they have
  Eigen::Index held = 0;   ///< so many leading elements stay
};

struct Minimum {
  Eigen::VectorXd z;
  Picture picture;       ///< there
  bool settled = false;  ///< no step, less damped or more, promises more than the least gain and keeps any of it
  bool ran_out = false;  ///< of steps
  Eigen::VectorXd last_step = {};  ///< empty where none was made
};

/// A local minimum by Levenberg and Marquardt's method within the bounds. Nothing where the start cannot be computed.
///
/// It ends where it is settled, where three steps in a row keep less than the least gain, or where the steps run out.
[[nodiscard]] std::optional<Minimum> minimise(const LeastSquaresProblem& problem, Eigen::VectorXd start,
                                              const MinimiseOptions& options = {});

}  // namespace zwidth::internal
