#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace zwidth {

enum class Motion;

/// A motor behind a joint, for files that have none.
struct Transmission {
  std::string joint;           ///< that it drives
  double ratio = 1.0;          ///< motor turns per turn of the joint; > 0
  double inertia = 0.0;        ///< of the motor, kg m^2; > 0
  double motor_damping = 0.0;  ///< of the motor to ground, N m s/rad; >= 0
  double stiffness = 0.0;      ///< of the cable, at the joint, N m/rad; 0: the motor turns with the joint
  double damping = 0.0;        ///< of the cable, at the joint, N m s/rad
};

/// A number of a mechanism's own file.
struct MechanismNumber {
  double value = 0.0;  ///< in SI units and radians
  Motion motion = {};  ///< which units it has: of a slide linear, of a hinge rotary
};

/// A file of MuJoCo's format (MJCF) or URDF, and where it is looked at.
struct MechanismFile {
  std::string path;                   ///< of the file; empty where `text` is given
  std::string tip;                    ///< site or body, where the wall is touched and the user holds
  std::vector<std::string> encoders;  ///< joints that are read; empty: those that actuators drive, and the motors
  std::map<std::string, double>
      pose;  ///< of joints, m or rad; others follow loops and cables, or stay where the file has them
  std::vector<Transmission> transmissions;           ///< in addition to the file's actuators
  std::string text = {};                             ///< what the file says, in its place; names no other file
  std::map<std::string, Motion> units_of_pose = {};  ///< linear: m, rotary: rad; of joints that have no other motion
  /// Numbers of the mechanism's file that are others here, by key: "joint.elbow.damping", "tendon.cable 1.stiffness".
  std::map<std::string, double> numbers = {};
  std::map<std::string, Motion> units_of_numbers = {};  ///< of some of `numbers`; of joints that have no other motion
  /// What the file says of all its numbers that have keys; found by device_of_mechanism().
  std::map<std::string, MechanismNumber> file_numbers = {};
};

/// What a device of a mechanism is made of: a direction at a pose.
struct MechanismDirection {
  MechanismFile mechanism;            ///< and its pose
  std::array<double, 3> normal = {};  ///< of the wall, in the world's frame; not all 0
  bool is_point = false;              ///< the wall acts in every direction that the tip can move; `normal` is not read
};

}  // namespace zwidth
