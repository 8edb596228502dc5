#pragma once

#include <Eigen/Core>

#include "zwidth/model/device.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth {

/// x' = A x + B u, y = C x: one force in, one position out; A is n x n, B n x 1, C 1 x n.
struct ContinuousStateSpace {
  Eigen::MatrixXd A;     ///< n x n
  Eigen::VectorXd B;     ///< n, of the actuator's force
  Eigen::RowVectorXd C;  ///< n, to the sensed position
};

/// The device in physical coordinates: positions of all bodies, their velocities, then the lagged force and the two states of the drive's
/// tracking if any.
///
///     M x'' + D x' + K x = e_actuated F,   y = e_sensed x
///
/// A transfer-function device comes in controllable canonical form. Operator, actuator lag and tracking included.
[[nodiscard]] ContinuousStateSpace state_space(const Device& device);

}  // namespace zwidth
