#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/model/mechanism_file.hpp"
#include "zwidth/model/tip_motion.hpp"

namespace zwidth {

/// Positions of joints by their names, m of a slide or rad of a hinge.
using JointPositions = std::map<std::string, double>;

/// A mechanism at a pose, linearised at rest with gravity compensated, in n coordinates q.
///
///     M q'' + (sum d w w') q' + (sum k w w') q = A_m' tau,   y = A_e q,   x = J q
struct MechanismAtPose {
  Eigen::MatrixXd mass;                          ///< M, n x n
  std::vector<Coordinates::Element> elements;    ///< springs and dampers of joints and cables
  std::vector<Coordinates::Friction> frictions;  ///< of joints and cables
  Eigen::MatrixXd cables;              ///< T, whose lengths T q the controller takes for constant: those with stiffness
  Eigen::MatrixXd motors;              ///< A_m: a row a motor
  Eigen::MatrixXd encoders;            ///< A_e: a row an encoder
  Eigen::MatrixXd tip;                 ///< J, 3 x n, in the world's frame
  Eigen::MatrixXd joint_motions = {};  ///< of the file's joints: a row a joint of MechanismModel::joints()
  Eigen::VectorXd joints = {};         ///< where the file's joints are, as MechanismModel::joints()
  Eigen::Vector3d tip_position = Eigen::Vector3d::Zero();  ///< m, in the world's frame
  std::vector<Eigen::MatrixXd> tips_beside = {};           ///< TipMotion::tips_beside, at a singular pose
};

/// From where to where a joint moves, m or rad.
struct JointRange {
  double least = 0.0;     ///< first end
  double greatest = 0.0;  ///< other end
};

/// A joint of a mechanism's file.
struct MechanismJoint {
  std::string name;                      ///< in the file; its number where it has none
  Motion motion = Motion::rotary;        ///< linear: a slide, m; rotary: a hinge, rad
  double position = 0.0;                 ///< in the file's own pose, m or rad
  std::optional<JointRange> range = {};  ///< that the file gives
  bool is_driven = false;                ///< an actuator of the file turns it
  bool is_of_pose = false;               ///< among those that give a pose: see MechanismModel::pose_joints()
};

/// A mechanism's file, read once and looked at in many poses.
///
/// A value; copies share what was read, which nothing changes. All may be asked from several threads at once.
class MechanismModel {
 public:
  /// Reads the file. Throws Error (invalid_argument) as at_pose() does, at the file's pose too.
  explicit MechanismModel(const MechanismFile& file);

  /// All joints of the file, in its order.
  [[nodiscard]] const std::vector<MechanismJoint>& joints() const;

  /// Joints that give a pose, the others following: which loops and unstretched cables leave independent of each other.
  ///
  /// First those that the file's pose names, then those that actuators drive without a cable, then what moves freely.
  [[nodiscard]] std::vector<std::string> pose_joints() const;

  /// What was read, with its pose.
  [[nodiscard]] const MechanismFile& file() const;

  /// Numbers of the file that have keys, as the file says them, whatever file().numbers puts in their place.
  ///
  /// "joint.NAME.damping", "stiffness" and "armature" (inertia beside the bodies'); "tendon.NAME.stiffness" and "damping". A
  /// joint or tendon without a name has none.
  [[nodiscard]] const std::map<std::string, MechanismNumber>& file_numbers() const;

  /// What was read of the file and of those that it includes, as one text that names no file: `text` of a MechanismFile
  /// without a path. Each element of the file stands in its line; what does not count is left out.
  [[nodiscard]] std::string text() const;

  /// The mechanism where these joints are there, and of others those of the file's pose. Throws Error as at_pose() does.
  ///
  /// A pose is singular where the tip moves along fewer directions than in poses around the file's. There, with U_0 the
  /// directions that it lost, J and the slope of U_0' J by each of pose_joints() and by all at once have the rows in which
  /// users beside the pose hold it: MechanismAtPose::tips_beside.
  [[nodiscard]] MechanismAtPose at(const JointPositions& pose = {}) const;

  /// How close the tip comes to a point.
  struct Reached {
    JointPositions pose;    ///< of pose_joints(), the closest that was found
    double short_of = 0.0;  ///< m, from the tip to the point: at most 1e-9 where it is reached
    bool reached = false;   ///< to 1e-9 m
  };
  /// A pose of pose_joints() with the tip at a point of the world's frame, m, from the file's pose on.
  ///
  ///     minimise |x(q) - point|,  loops closed, cables not stretched, ranges of joints kept
  ///
  /// Damped Gauss-Newton steps (Levenberg-Marquardt), at most 200, from the file's pose, and where that ends short from some
  /// around it. Throws Error (invalid_argument) for a point that is not finite.
  [[nodiscard]] Reached reach(const Eigen::Vector3d& point) const;

 private:
  class Read;
  std::shared_ptr<const Read> read_;
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
/// `parameters` gives all but bodies, links and which points the loop names. The user of `parameters` holds the tip along the
/// normal alone; any passive user grasps it in every direction.
/// Throws Error (invalid_argument) for a normal of length 0, one along which the tip cannot move, and where encoders or
/// motors do not determine its motion, or one of them depends on others. Source: docs/theory.md, "Several axes".
[[nodiscard]] Device device_along(const MechanismAtPose& mechanism, const Eigen::Vector3d& normal,
                                  DeviceParameters parameters);

/// The same in all directions that the tip can move: what device_along() senses and pushes along a normal n is n' S_s, n' S_a.
///
/// Throws Error (invalid_argument) where encoders or motors do not determine the tip's motion, or one of them depends on
/// others. Source: docs/theory.md, "Several axes".
[[nodiscard]] TipMotion tip_motion(const MechanismAtPose& mechanism);

/// The device of `parameters.mechanism`: at_pose(), then device_along(), which throw; of a point wall tip_motion().
[[nodiscard]] Device device_of_mechanism(DeviceParameters parameters);

}  // namespace zwidth
