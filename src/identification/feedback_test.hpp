#pragma once

#include <vector>

#include "identification/shot_fit.hpp"

namespace zwidth::internal {

/// How clearly each record's force answers to the noise of its position: made from the motion by a controller, not
/// beforehand.
///
///     sqrt(max_{tau >= 0} z(tau)^2 - max_{tau < 0} z(tau)^2),   z = sum_k e[k] v[k + tau] / sqrt(sum_k (e[k] v[k + tau])^2)
///
/// e: what is left of the position, v: the force, each made white by its own autoregression. Without feedback every z is
/// a standard normal number; above 5 there is one. Then disturbances are in the recorded force too, and bias a fit
/// (Ljung, System Identification, sec. 13.4). What hangs on the force before it as on the force after it is no answer to
/// it: the rounding of a coarse encoder, a structure that is wrong.
[[nodiscard]] std::vector<double> feedback_evidence(const ShotModel& model, const std::vector<Shot>& shots,
                                                    const std::vector<ShotNoise>& noise,
                                                    const ShotPositions& residuals);

}  // namespace zwidth::internal
