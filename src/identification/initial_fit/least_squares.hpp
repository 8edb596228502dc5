#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "identification/initial_fit/fit_model.hpp"

namespace zwidth::internal {

/// What a fit compares at each frequency.
enum class Misfit {
  weighted,     ///< (model - measured) / deviation: the statistical fit
  logarithmic,  ///< log(model / measured): forgiving far from the solution, for starting points
};

/// The measurement as a fit sees it; all of one size.
struct FitData {
  std::vector<double> frequencies;  ///< rad/s
  std::vector<std::complex<double>> measured;
  std::vector<double> deviations;  ///< standard deviation of |measured|; > 0; weighted only
};

/// A weak pull towards a position, for coordinates that the data leave free.
struct Pull {
  Eigen::VectorXd towards;
  Eigen::VectorXd strength;  ///< 0: none; else 1 / standard deviation
};

struct LeastSquaresOptions {
  Misfit misfit = Misfit::weighted;
  double robust_threshold = 3.0;  ///< in deviations (weighted) or nepers (logarithmic); 0: none
  int most_iterations = 200;
  double tolerance = 1e-8;  ///< relative change of the cost at which the iterations end
};

struct LeastSquares {
  Eigen::VectorXd x;
  double cost = 0.0;
  bool converged = false;  ///< false: the iterations ran out, or the model could not be evaluated
};

/// min over x of sum_i rho(|misfit_i|^2) + the pull, by Levenberg and Marquardt's method (Ceres).
[[nodiscard]] LeastSquares least_squares(const FitModel& model, const FitData& data, const Eigen::VectorXd& start,
                                         const LeastSquaresOptions& options, const Pull& pull = {});

}  // namespace zwidth::internal
