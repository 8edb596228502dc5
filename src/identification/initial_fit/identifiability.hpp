#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "identification/initial_fit/fit_model.hpp"
#include "identification/initial_fit/least_squares.hpp"

namespace zwidth::internal {

/// Which coordinates the data determine.
struct Identifiability {
  std::vector<bool> determined;  ///< by the data alone, one per coordinate
  /// All but those that do not show, and one of each combination: these are known given that one, and together with it
  /// they say how well the combination is known.
  std::vector<bool> estimated;
  std::vector<std::vector<std::size_t>> combinations;  ///< coordinates of which only a combination shows, or nothing

  /// Alone or in a combination.
  [[nodiscard]] bool shows(std::size_t coordinate) const {
    return !std::ranges::any_of(combinations, [&](const std::vector<std::size_t>& each) {
      return each.size() == 1 && each.front() == coordinate;
    });
  }
};

/// From the eigenvalues of the normal matrix, scaled to correlations: those that vanish belong to directions in which
/// the response does not change at all.
[[nodiscard]] Identifiability identifiability(const ResponseWithSlopes& at_solution, const FitData& data);

/// Of the squares of slopes of norm 1, below which one vanishes. Slopes are differences, good to 1e-7: an eigenvalue that
/// is 0 comes out at 1e-13 or so.
inline constexpr double least_eigenvalue = 1e-10;

/// 1 / standard deviation of what is known of a coordinate before the data: 28 as a factor, or 3.3 typical values.
inline constexpr double known_beforehand = 0.3;

/// Covariance of the coordinates that show at the solution, 0 for the others.
///
/// A^-1 B A^-1 with the normal matrix A and the scores' covariance B (White 1980): B takes the residuals' size from
/// around each point, and their correlation from the whole band, so that deviations which are wrong, and lines which a
/// window correlates, do not spoil the intervals. Along the directions that vanish, known_beforehand takes A's place: one
/// that hardly shows is not one that does not, and what it moves a little it may move far.
[[nodiscard]] Eigen::MatrixXd covariance(const ResponseWithSlopes& at_solution, const FitData& data,
                                         const Identifiability& known, double robust_threshold);

}  // namespace zwidth::internal
