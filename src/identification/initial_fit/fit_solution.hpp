#pragma once

#include <optional>
#include <vector>

#include "identification/initial_fit/fit_model.hpp"
#include "identification/initial_fit/least_squares.hpp"

namespace zwidth::internal {

/// Where a search begins, and where it is weakly drawn.
struct Start {
  Eigen::VectorXd x;
  Pull pull;
};

/// A start at x that is drawn to x itself. Every mass and stiffness is taken as known to a factor of 28 (one standard
/// deviation) beforehand: what the data determine does not feel it, and what they leave open does not drift away.
[[nodiscard]] Start start_at(const FitModel& model, const Eigen::VectorXd& x);

/// The same, with the coordinates that the data leave open drawn to another position.
[[nodiscard]] Start start_at(const FitModel& model, const Eigen::VectorXd& x, const Eigen::VectorXd& towards,
                             const std::vector<bool>& determined);

/// A position, and others that a search does not reach from there: links that hardly spring with their modes at twice
/// `highest` (with_springs()), since they take the phase of a lag; and where delay and lag are free, either with half of
/// their sum on each, since a lag near 0 is a delay.
[[nodiscard]] std::vector<Start> starts_near(const FitModel& model, const Eigen::VectorXd& x, double highest);

/// A fit and the model error that goes with it.
struct Solution {
  Eigen::VectorXd x;
  double model_error = 0.0;
  Pull pull;            ///< of the start that it was found from
  bool settled = true;  ///< false: the iterations ran out while the fit still improved
};

/// Starting points from the data, the best first: after a fit of the logarithm at some of the points.
[[nodiscard]] std::vector<Start> promising_starts(const FitModel& model, const std::vector<ResponsePoint>& points);

/// Alternates between the parameters and the model error that weights the points, from the start that explains the data
/// best. Throws Error (did_not_converge).
[[nodiscard]] Solution solve(const FitModel& model, const std::vector<ResponsePoint>& points,
                             const std::vector<Start>& starts, double robust_threshold);

/// A solution that leaves more than the noise, or what is no noise, may be a side minimum: the best of it and of those that
/// the search reaches with each link's resonance elsewhere, in the band, below or above. One that explains the response to
/// its noise, and leaves nothing alike from line to line, is returned as it is.
[[nodiscard]] Solution searched_widely(const FitModel& model, const FrequencyResponse& response, Solution found,
                                       double robust_threshold);

/// The best of a solution and those that the search reaches with the links' resonances near these modes, rad/s: those that
/// the solution has and one that it lacks.
[[nodiscard]] Solution searched_near(const std::vector<double>& modes, const FitModel& model,
                                     const std::vector<ResponsePoint>& points, Solution found, double robust_threshold);

/// The solution with what the data leave open drawn to another position, as far as the data allow: where they are
/// explained worse there, the solution itself.
[[nodiscard]] Solution drawn_back(const FitModel& model, const std::vector<ResponsePoint>& points,
                                  const Solution& solution, const Eigen::VectorXd& towards,
                                  const std::vector<bool>& determined, double robust_threshold);

}  // namespace zwidth::internal
