#pragma once

#include <Eigen/Core>
#include <vector>

#include "identification/initial_fit/fit_model.hpp"
#include "identification/initial_fit/response_features.hpp"

namespace zwidth::internal {

/// Positions from which a fit may find the global minimum, the most promising first; at least one.
///
/// Masses, stiffnesses and dampings are combined from what the response shows: the line at low frequencies (whole mass,
/// or static stiffness), the one at high frequencies (mass of the actuated body), resonances and antiresonances
/// (stiffness over reduced mass), the slope of the phase (delay and lag). Every combination is judged by the mean
/// logarithmic misfit at some of the points, and the best are kept. Fixed parameters keep the structure's values.
[[nodiscard]] std::vector<Eigen::VectorXd> initial_positions(const FitModel& model,
                                                             const std::vector<ResponsePoint>& points,
                                                             const ResponseFeatures& features);

/// The best of these for every choice of where the links resonate, in the band, below or above, with bodies alike and
/// not; at most so many, the most promising first.
[[nodiscard]] std::vector<Eigen::VectorXd> different_positions(const FitModel& model,
                                                               const std::vector<ResponsePoint>& points,
                                                               const ResponseFeatures& features, std::size_t most);

}  // namespace zwidth::internal
