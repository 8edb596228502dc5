#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "identification/contradicted_number.hpp"
#include "identification/recording_agreement.hpp"
#include "identification/shot_covariance.hpp"
#include "identification/shot_model.hpp"
#include "identification/shot_search.hpp"
#include "zwidth/identification/time_domain.hpp"

namespace zwidth::internal {

/// Estimates, correlations, what is not identifiable, and the device with its uncertainty.
void describe_parameters(TimeDomainIdentification& result, const ShotModel& model, const ShotFit& fit,
                         const ShotCovariance& known);

/// x after a step, within the bounds of what may not be negative (bring_within()).
[[nodiscard]] Eigen::VectorXd moved(const ShotModel& model, const Eigen::VectorXd& x, Eigen::VectorXd step,
                                    const Eigen::MatrixXd& covariance);

/// Where a fit of shots came to rest.
struct FittedDevice {
  const ShotModel& model;
  const std::vector<Shot>& shots;
  const FittedShots& fitted;
  const ShotCovariance& known;
};

/// Newton's step of each recording alone, from the fit of all: the device as that recording has it.
[[nodiscard]] std::vector<OwnDevice> devices_of_recordings(const FittedDevice& fitted,
                                                           std::span<const Recording> recordings);

/// Masses, dampings, links and frictions that were taken as they stand in the structure although the residuals pull them
/// away from there, all that was free following: by more than 5 deviations and 2 % of their value. Of a spring to the ground
/// that is not in the structure: by 2 % of the force at `lowest`, rad/s.
[[nodiscard]] std::vector<ContradictedNumber> contradicted_numbers(const FittedDevice& fitted, const Device& structure,
                                                                   std::span<const Recording> recordings,
                                                                   const std::vector<std::string>& locked,
                                                                   double lowest);

}  // namespace zwidth::internal
