#pragma once

#include <Eigen/Core>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/model/mechanism_file.hpp"
#include "zwidth/model/tip_motion.hpp"

namespace zwidth {

/// A mechanism at a pose, linearised at rest with gravity compensated, in n coordinates q.
///
///     M q'' + (sum d w w') q' + (sum k w w') q = A_m' tau,   y = A_e q,   x = J q
struct MechanismAtPose {
  Eigen::MatrixXd mass;                          ///< M, n x n
  std::vector<Coordinates::Element> elements;    ///< springs and dampers of joints and cables
  std::vector<Coordinates::Friction> frictions;  ///< of joints and cables
  Eigen::MatrixXd cables;    ///< T, whose lengths T q the controller takes for constant: those with stiffness
  Eigen::MatrixXd motors;    ///< A_m: a row a motor
  Eigen::MatrixXd encoders;  ///< A_e: a row an encoder
  Eigen::MatrixXd tip;       ///< J, 3 x n, in the world's frame
};

/// Reads the file and goes to the pose.
///
/// Joints must be hinges or slides. Throws Error (invalid_argument): what the file's reader says, with its line; a joint or
/// tip of no such name; a loop that does not close; neither actuators nor transmissions; built without MuJoCo.
[[nodiscard]] MechanismAtPose at_pose(const MechanismFile& file);

/// The device along a normal: a wall that knows the tip by its encoders, cables not stretched, and pushes it by its motors.
///
///     x = J_e y,  tau = J_m' f,  J_e = J N,  [T; A_e] N = [0; 1]
///
/// `parameters` gives all but bodies, links and which points the loop names. The user holds the tip along the normal alone.
/// Throws Error (invalid_argument) for a normal of length 0, one along which the tip cannot move, and where encoders or
/// motors do not determine its motion, or one of them depends on others. Source: theory, section 9.
[[nodiscard]] Device device_along(const MechanismAtPose& mechanism, const Eigen::Vector3d& normal,
                                  DeviceParameters parameters);

/// The same in all directions that the tip can move: what device_along() senses and pushes along a normal n is n' S_s, n' S_a.
///
/// Throws Error (invalid_argument) where encoders or motors do not determine the tip's motion, or one of them depends on
/// others. Source: theory, section 9.
[[nodiscard]] TipMotion tip_motion(const MechanismAtPose& mechanism);

/// The device of `parameters.mechanism`: at_pose(), then device_along(), which throw; of a point wall tip_motion().
[[nodiscard]] Device device_of_mechanism(DeviceParameters parameters);

}  // namespace zwidth
