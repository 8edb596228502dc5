#pragma once

#include <Eigen/Core>

#include "identification/evidence/response_evidence.hpp"
#include "identification/model/device_family.hpp"
#include "identification/verdict/omnibus.hpp"
#include "zwidth/signal/frequency_response.hpp"

namespace zwidth::internal {

/// By how much fewer lines count: neighbours share their noise, and few averages leave the noise's size open.
[[nodiscard]] double shared_noise(const FrequencyResponse& response);

/// Squares of what a fit leaves, and how many of them are independent and of mean 1.
struct SumOfSquares {
  double sum = 0.0;
  double freedom = 0.0;
};

/// Sums of what the fit leaves in bands of neighbouring lines, each line over its deviation, freed of what the fit takes of them:
///
///     cov = I - J H^-1 J'
///
/// A structure that lacks something leaves neighbours alike, which the model error e does not count. `covariance`: H^-1, of the
/// numbers; z: these, then log e.
[[nodiscard]] SumOfSquares squares_of_bands(const DeviceFamily& family, const ResponseEvidence& evidence,
                                            const FrequencyResponse& response, const Eigen::VectorXd& z,
                                            const Eigen::MatrixXd& covariance);

/// The test of them: what is left follows the force.
[[nodiscard]] Omnibus omnibus_of_lines(const SumOfSquares& squares);

}  // namespace zwidth::internal
