#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "identification/optimiser/least_squares_problem.hpp"
#include "identification/optimiser/minimise.hpp"

namespace zwidth::internal {

/// A number that hangs on z, as a logarithm; nothing where there is none.
using LogOf = std::function<std::optional<double>(const Eigen::VectorXd& z)>;

/// An end of a profile.
struct ProfileEnd {
  double value = 0.0;  ///< the logarithm there; where the search was stopped, as far out as it may lie
  Eigen::VectorXd z;
  double last_change = 0.0;  ///< of the logarithm, by which `value` may be off; 0 where no step led further
  /// The cost fell below the minimum's: that was none.
  bool found_better = false;
};

/// The least (direction -1) or largest (+1) value of a number over all z whose cost is within `rise` of the minimum's, everything
/// else refitted along the way: steps of Gauss and Newton on the boundary (Venzon & Moolgavkar 1988). One that costs more is drawn
/// back towards the minimum, one that leads no further is damped.
///
/// `varied`: how many leading elements of z the number hangs on.
[[nodiscard]] ProfileEnd profile_end(const LeastSquaresProblem& problem, const Minimum& minimum, const LogOf& number,
                                     Eigen::Index varied, double direction, double rise);

/// A number at the minimum, and its ends.
struct ProfileRange {
  double middle = 0.0;
  ProfileEnd low;
  ProfileEnd high;
};

/// The number that is profiled, where it hangs on the minimum itself; nothing where there is none.
using NumberAt = std::function<std::optional<LogOf>(const Minimum& minimum)>;

/// Both ends. Where one is more likely than the minimum, that was none: the search goes on from there, and `minimum` is the last one.
/// Where it gives way again and again, its ends say by how much in last_change. Nothing where there is no number at the minimum.
[[nodiscard]] std::optional<ProfileRange> profile_range(const LeastSquaresProblem& problem, Minimum& minimum,
                                                        const NumberAt& number_at, Eigen::Index varied, double rise,
                                                        const MinimiseOptions& options);

/// How the number changes with each of the first `varied` elements of z; by differences.
[[nodiscard]] Eigen::VectorXd slope_of(const LogOf& number, const Eigen::VectorXd& z, Eigen::Index varied,
                                       const Eigen::VectorXd& lowest);

/// How much a number that hangs on z by `slope` changed with the last step of a search that was stopped; 0 where it came to rest.
[[nodiscard]] double last_change(const Minimum& minimum, const Eigen::VectorXd& slope);

/// H^-1 v and H^-1, in units in which the diagonal of H is 1: what the data hardly tell stays apart from rounding.
[[nodiscard]] Eigen::VectorXd covariance_times(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& vector);
[[nodiscard]] Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& hessian);

}  // namespace zwidth::internal
