#pragma once

#include <Eigen/Core>
#include <functional>

#include "identification/initial_fit/fit_model.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// A of x' = A x with nothing sticking, x as in ContinuousMotion: (q_0, q_i - q_0, v_i, lagged force, commanded force,
/// friction forces).
[[nodiscard]] Eigen::MatrixXd motion_matrix(const Device& device);

/// dA/dp of a coordinate's parameter p, of the device that `as_played` makes of the parameters.
///
/// A is affine in each parameter, or in the inverse of a body's whole mass, its operator's included, or of a lag: its
/// slope follows from a second value. None by a delay, or by a lag that the device lacks.
[[nodiscard]] Eigen::MatrixXd motion_slope(const DeviceParameters& parameters, const Coordinate& coordinate,
                                           const std::function<Device(const DeviceParameters&)>& as_played);

}  // namespace zwidth::internal
