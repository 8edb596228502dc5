#pragma once

// planar_arm.xml by its equations of motion: shoulder, elbow, motor 1, motor 2.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/model/tip_motion.hpp"

namespace zwidth::planar_arm {

struct Pose {
  double shoulder = 0.0;
  double elbow = 0.0;
};

/// Along a normal in the plane, with a wall there: the controller knows the tip by the motors alone.
inline DeviceParameters device(Pose pose, double nx, double ny) {
  constexpr double upper = 0.2;
  constexpr double tip = 0.25;
  constexpr double upper_centre = 0.1;
  constexpr double fore_centre = 0.12;
  constexpr double upper_mass = 0.15;
  constexpr double fore_mass = 0.10;
  constexpr double inertia = 6e-4;
  constexpr double ratio = 0.1;
  const double coupling = upper * fore_centre * std::cos(pose.elbow);
  const double fore = fore_mass * fore_centre * fore_centre + inertia;
  const double both = fore + fore_mass * coupling;
  const double whole =
      upper_mass * upper_centre * upper_centre + inertia + fore + fore_mass * (upper * upper + 2.0 * coupling);
  const double sine = tip * std::sin(pose.shoulder + pose.elbow);
  const double cosine = tip * std::cos(pose.shoulder + pose.elbow);
  const double by_shoulder =
      nx * (-upper * std::sin(pose.shoulder) - sine) + ny * (upper * std::cos(pose.shoulder) + cosine);
  const double by_elbow = -nx * sine + ny * cosine;
  DeviceParameters parameters;
  parameters.name = "planar arm";
  parameters.loop.sampling_period = 1e-3;
  parameters.loop.held = 1;
  parameters.coordinates = {
      .mass = {whole, both, 0.0, 0.0, both, fore, 0.0, 0.0, 0.0, 0.0, 8e-5, 0.0, 0.0, 0.0, 0.0, 8e-5},
      .elements = {{{1.0, 0.0, 0.0, 0.0}, 0.0, 2e-3},
                   {{0.0, 1.0, 0.0, 0.0}, 0.0, 2e-3},
                   {{0.0, 0.0, 1.0, 0.0}, 0.0, 2e-4},
                   {{0.0, 0.0, 0.0, 1.0}, 0.0, 2e-4},
                   {{-1.0, 0.0, ratio, 0.0}, 400.0, 0.05},
                   {{0.0, -1.0, 0.0, ratio}, 300.0, 0.05}},
      .points = {{"wall", {0.0, 0.0, ratio * by_shoulder, ratio * by_elbow}},
                 {"tip", {by_shoulder, by_elbow, 0.0, 0.0}}}};
  return parameters;
}

/// In all directions at once.
inline TipMotion tip_motion(Pose pose) {
  TipMotion motion;
  motion.tip = motion.sensed = motion.pushed = Eigen::MatrixXd::Zero(3, 4);
  for (int axis = 0; axis < 2; ++axis) {
    const Coordinates along = *device(pose, axis == 0 ? 1.0 : 0.0, axis == 0 ? 0.0 : 1.0).coordinates;
    motion.mass = Eigen::Map<const Eigen::Matrix4d>(along.mass.data());
    motion.elements = along.elements;
    motion.sensed.row(axis) = Eigen::Map<const Eigen::RowVector4d>(along.points[0].weights.data());
    motion.tip.row(axis) = Eigen::Map<const Eigen::RowVector4d>(along.points[1].weights.data());
  }
  motion.pushed = motion.sensed;
  return motion;
}

}  // namespace zwidth::planar_arm
