#pragma once

#include <vector>

#include "identification/initial_fit/least_squares.hpp"

namespace zwidth::internal {

/// The points with deviations sqrt(variance + model_error^2 |P|^2).
[[nodiscard]] FitData fit_data(const std::vector<ResponsePoint>& points, double model_error);

/// The least e >= 0 with median |r_i|^2 / (variance_i + e^2 |P_i|^2) <= ln 2, which is what it is for complex normal
/// residuals of these variances. The median does not heed a few lines that friction or a missing mode spoils.
[[nodiscard]] double model_error_of(const std::vector<ResponsePoint>& points, const Eigen::VectorXcd& fitted);

}  // namespace zwidth::internal
