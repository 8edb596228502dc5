#pragma once

#include <string_view>

#include "zwidth/model/device.hpp"

namespace zwidth {

/// Whether the key is of a number of a mechanism or of a motor in it: "mechanism.pose.elbow", "transmission.0.ratio".
[[nodiscard]] bool is_key_of_mechanism(std::string_view key);

/// Whether the key is of a joint's position.
[[nodiscard]] bool is_key_of_pose(std::string_view key);

/// Whether the key is of a number of the mechanism's own file: "mechanism.joint.elbow.damping".
[[nodiscard]] bool is_key_of_mechanism_file(std::string_view key);

/// What a key of MechanismFile::numbers says: "joint.elbow.damping"; the name of a part may hold dots.
struct MechanismNumberName {
  /// Of such a key, which the views are of.
  explicit MechanismNumberName(std::string_view key);

  std::string_view kind;       ///< "joint" or "tendon"
  std::string_view part;       ///< its name in the mechanism's file
  std::string_view attribute;  ///< "damping", "stiffness", "armature"
};

/// The motion that the number's unit is of: the device's, but for motors and joints of a mechanism.
[[nodiscard]] Motion motion_of_key(const DeviceParameters& parameters, std::string_view key);

/// Throws Error (invalid_argument, of the key mechanism.normal) where is_point_wall(): for what is of one direction.
void require_one_direction(const Device& device);

}  // namespace zwidth
