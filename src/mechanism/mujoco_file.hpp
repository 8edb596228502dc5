#pragma once

// Mechanism files by MuJoCo, which no other file knows.

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "zwidth/mechanism.hpp"

namespace zwidth::internal {

// What was read of a file; nothing changes it, and several threads may ask it at once. The program loads what is behind it
// on demand.
class MujocoFile {
 public:
  MujocoFile() = default;
  MujocoFile(const MujocoFile&) = delete;
  MujocoFile& operator=(const MujocoFile&) = delete;
  virtual ~MujocoFile() = default;

  // MechanismModel::text()
  [[nodiscard]] virtual std::string text() const = 0;
  // But for which of them give a pose.
  [[nodiscard]] virtual std::vector<MechanismJoint> joints() const = 0;
  // As MechanismModel::file_numbers()
  [[nodiscard]] virtual const std::map<std::string, MechanismNumber>& numbers() const = 0;
  // The number of that joint; refuses, with the key, a name that no joint has.
  [[nodiscard]] virtual int joint(const std::string& key, const std::string& name) const = 0;

  // In the coordinates of all joints, and which of their motions the loops leave free: q' = Z z'.
  struct At {
    MechanismAtPose mechanism;
    Eigen::MatrixXd free_motions;
  };
  // With the file's own motors.
  [[nodiscard]] virtual At at(const JointPositions& pose) const = 0;
};

// With the numbers of `file` in it. Throws Error as at_pose() does for what its text says.
[[nodiscard]] std::shared_ptr<const MujocoFile> open_mujoco_file(const MechanismFile& file);

}  // namespace zwidth::internal
