#include "identification/model/linear_step.hpp"

#include <algorithm>

#include "identification/held_device.hpp"
#include "model/device_matrices.hpp"
#include "sampling/matrix_exponential.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

Device in_experiment(const DeviceParameters& parameters, const std::vector<std::string>& locked) {
  const Device device(parameters);
  if (locked.empty()) return device;
  std::vector<std::size_t> still;
  for (const std::string& name : locked) still.push_back(device.body_index(name));
  return locked_device(device, still);
}

/// What the key's mass moves with: the body's and, where it is held, its user's.
double moved_mass(const DeviceParameters& parameters, const std::string& key) {
  const Body& held = parameters.bodies[parameters.loop.held];
  const bool is_held = key == "operator.mass" || key == "body." + held.name + ".mass";
  return is_held ? held.mass + parameters.user.mass : *parameter(parameters, key);
}

}  // namespace

Eigen::MatrixXd motion_columns(const Device& device) {
  const DeviceMatrices<double> matrices = device_matrices<double>(device);
  const auto bodies = static_cast<Eigen::Index>(device.bodies().size());
  const double lag = device.parameters().actuator.time_constant;
  const Eigen::Index size = 2 * bodies + (lag > 0.0 ? 1 : 0);
  const auto held = static_cast<Eigen::Index>(device.loop().held);
  const auto actuated = static_cast<Eigen::Index>(device.loop().actuated);
  const auto at = [&](Eigen::Index i, Eigen::Index j) { return static_cast<std::size_t>(i * bodies + j); };
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(size, size + 1 + bodies);
  columns(0, bodies) = 1.0;
  for (Eigen::Index i = 1; i < bodies; ++i) {
    columns(i, bodies + i) = 1.0;
    columns(i, bodies) = -1.0;
  }
  for (Eigen::Index i = 0; i < bodies; ++i) {
    const Eigen::Index row = bodies + i;
    const double mass = matrices.mass[static_cast<std::size_t>(i)];
    const double ground = device.bodies()[static_cast<std::size_t>(i)].stiffness;
    columns(row, 0) = -(ground + (i == held ? device.parameters().user.stiffness : 0.0)) / mass;
    for (Eigen::Index j = 1; j < bodies; ++j) columns(row, j) = -matrices.stiffness[at(i, j)] / mass;
    for (Eigen::Index j = 0; j < bodies; ++j) columns(row, bodies + j) = -matrices.damping[at(i, j)] / mass;
    columns(row, size + 1 + i) = 1.0 / mass;
  }
  const double mass = matrices.mass[static_cast<std::size_t>(actuated)];
  if (lag > 0.0) {
    columns(bodies + actuated, size - 1) = 1.0 / mass;
    columns(size - 1, size - 1) = -1.0 / lag;
    columns(size - 1, size) = 1.0 / lag;
  } else {
    columns(bodies + actuated, size) = 1.0 / mass;
  }
  return columns;
}

Eigen::MatrixXd motion_columns_slope(const DeviceParameters& parameters, const std::string& key, double unit,
                                     const std::vector<std::string>& locked) {
  const Eigen::MatrixXd here = motion_columns(in_experiment(parameters, locked));
  const double value = *parameter(parameters, key);
  if (key == "loop.delay") return Eigen::MatrixXd::Zero(here.rows(), here.cols());
  double step = std::max(value, unit);
  double factor = 1.0 / step;
  if (key.ends_with(".mass") || key.ends_with(".time_constant")) {
    if (value == 0.0) return Eigen::MatrixXd::Zero(here.rows(), here.cols());
    step = key.ends_with(".mass") ? moved_mass(parameters, key) : value;  // 1/p becomes 1/2p
    factor = 2.0 / step;
  }
  DeviceParameters moved = parameters;
  set_parameter(moved, key, value + step);
  return factor * (motion_columns(in_experiment(moved, locked)) - here);
}

LinearStep linear_step(const Eigen::MatrixXd& columns, const std::vector<Eigen::MatrixXd>& slopes, double length) {
  const Eigen::Index rows = columns.rows();
  const Eigen::Index size = columns.cols();
  const auto square = [&](const Eigen::MatrixXd& of) {
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size, size);
    whole.topRows(rows) = length * of;
    return whole;
  };
  std::vector<Eigen::MatrixXd> squares;
  squares.reserve(slopes.size());
  for (const Eigen::MatrixXd& each : slopes) squares.push_back(square(each));
  ExponentialWithDerivatives whole = exponential_with_derivatives(square(columns), squares);
  whole.minus_one.diagonal().array() += 1.0;
  LinearStep step{whole.minus_one.topRows(rows), {}};
  for (const Eigen::MatrixXd& each : whole.derivatives) step.slopes.emplace_back(each.topRows(rows));
  return step;
}

}  // namespace zwidth::internal
