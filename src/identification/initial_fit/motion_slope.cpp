#include "identification/initial_fit/motion_slope.hpp"

#include <algorithm>

#include "simulation/continuous_motion.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

/// What the key's mass moves with: the body's and, where it is held, its operator's.
double whole_mass(const DeviceParameters& parameters, const std::string& key) {
  const Body& held = parameters.bodies[parameters.loop.held];
  const bool is_held = key == "operator.mass" || key == "body." + held.name + ".mass";
  return is_held ? held.mass + parameters.user.mass : *parameter(parameters, key);
}

}  // namespace

Eigen::MatrixXd motion_matrix(const Device& device) {
  return ContinuousMotion(device, {}, {}).patterns().front().matrix;
}

Eigen::MatrixXd motion_slope(const DeviceParameters& parameters, const Coordinate& coordinate,
                             const std::function<Device(const DeviceParameters&)>& as_played) {
  const double value = *parameter(parameters, coordinate.key);
  double step = std::max(value, coordinate.unit);
  double factor = 1.0 / step;
  if (coordinate.key.ends_with(".mass") || coordinate.key.ends_with(".time_constant")) {
    step = coordinate.key.ends_with(".mass") ? whole_mass(parameters, coordinate.key) : value;  // 1/p becomes 1/2p
    factor = 2.0 / step;
  }
  DeviceParameters moved = parameters;
  set_parameter(moved, coordinate.key, value + step);
  return factor * (motion_matrix(as_played(moved)) - motion_matrix(as_played(parameters)));
}

}  // namespace zwidth::internal
