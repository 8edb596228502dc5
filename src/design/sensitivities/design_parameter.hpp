#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// One of the numbers that a limit of the wall depends on.
struct DesignParameter {
  enum class Kind {
    body_mass,
    body_damping,
    body_stiffness,
    link_stiffness,
    link_damping,
    sampling_period,
    delay,
    time_constant,
    tracking_bandwidth,
    wall_damping,
    velocity_filter_hz,
    filter_frequency_hz,
    filter_damping_ratio,
    filter_depth,
    filter_ratio,
    user_mass,
    user_damping,
    user_stiffness,
    transmission,       // of a motor in a mechanism
    mechanism_damping,  // of the mechanism's file
    mechanism_stiffness,
    mechanism_inertia,
    joint_position,  // of a mechanism's pose
  };
  Kind kind = Kind::body_mass;
  std::size_t index = 0;  // of the body, link, filter or transmission
  std::string key;        // model/parameter.hpp
  double value = 0.0;
};

/// In the order of the device file. A velocity filter of 0 Hz, and a tracking of 0 rad/s, is none: no number that could grow.
[[nodiscard]] std::vector<DesignParameter> design_parameters(const Device& device);

}  // namespace zwidth::internal
