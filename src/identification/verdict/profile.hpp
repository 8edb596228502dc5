#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "identification/fit/least_squares_problem.hpp"
#include "identification/fit/minimise.hpp"

namespace zwidth::internal {

/// A number that hangs on z, as a logarithm; nothing where there is none.
using LogOf = std::function<std::optional<double>(const Eigen::VectorXd& z)>;

/// An end of a profile.
struct ProfileEnd {
  double value = 0.0;  ///< the logarithm there
  Eigen::VectorXd z;
  bool settled = false;
  /// The cost fell below the minimum's: that was none.
  bool found_better = false;
};

/// The least (direction -1) or largest (+1) value of a number over all z whose cost is within `rise` of the minimum's, everything
/// else refitted along the way: steps of Gauss and Newton on the boundary (Venzon & Moolgavkar 1988).
///
/// `varied`: how many leading elements of z the number hangs on.
[[nodiscard]] ProfileEnd profile_end(const LeastSquaresProblem& problem, const Minimum& minimum, const LogOf& number,
                                     Eigen::Index varied, double direction, double rise);

/// The deviation of a number by the curvature at the minimum: sqrt(s' H^-1 s), s its slope.
[[nodiscard]] double deviation_of(const Minimum& minimum, const LogOf& number, Eigen::Index varied,
                                  const Eigen::VectorXd& lowest);

}  // namespace zwidth::internal
