#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth {

/// The numbers of a device by their keys, as in `--set`: body.NAME.mass, .damping, .stiffness, .coulomb;
/// link.INDEX.stiffness, .damping (plain link where there is one); loop.sampling_period, .delay;
/// actuator.time_constant, .force_limit; sensor.resolution, .tracking_bandwidth; wall.stiffness, .damping, .velocity_filter_hz;
/// wall.filter.INDEX.frequency_hz, .damping_ratio, .depth, .ratio as its kind has them (plain wall.filter where there
/// is one); operator.mass, .damping, .stiffness. Of a mechanism mechanism.pose.JOINT; transmission.INDEX.ratio, .inertia,
/// .motor_damping, .stiffness, .damping; and, once it has been put to its pose, numbers of its own file:
/// mechanism.joint.NAME.damping, .stiffness, .armature, mechanism.tendon.NAME.stiffness, .damping.

/// Every key of the device that parameter() takes, in the order of the device file. Links always with their index.
[[nodiscard]] std::vector<std::string> parameter_keys(const DeviceParameters& parameters);

/// "body.NAME.mass" for "body.NAME.inertia", and so of the user: they are one here. Others as given.
[[nodiscard]] std::string without_alias(std::string_view key);

/// without_alias(), and with the index of its link: "link.stiffness" is "link.0.stiffness" where there is one link; others
/// as given.
[[nodiscard]] std::string full_parameter_key(const DeviceParameters& parameters, std::string_view key);

/// The value of the key; nothing for a key that the device does not have, or whose value is absent (a wall without
/// stiffness, no force limit).
[[nodiscard]] std::optional<double> parameter(const DeviceParameters& parameters, std::string_view key);

/// Sets the value, unchecked (Device checks it). Throws Error (invalid_argument) for an unknown key.
void set_parameter(DeviceParameters& parameters, std::string_view key, double value);

}  // namespace zwidth
