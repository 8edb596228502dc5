#include "identification/model/linear_step.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/device_matrices.hpp"
#include "sampling/matrix_exponential.hpp"

namespace zwidth::internal {
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

std::vector<Eigen::MatrixXd> motion_slopes(const DeviceFamily& family, const Eigen::VectorXd& x) {
  constexpr double relative = 3e-6;
  constexpr double least = 1e-4;  // of a unit
  std::vector<Eigen::MatrixXd> slopes;
  for (Eigen::Index i = 0; i < family.of_device(); ++i) {
    const Number& number = family.numbers()[static_cast<std::size_t>(i)];
    const double step = relative * std::max(std::abs(x(i)), number.scale == Number::Scale::logarithmic ? 1.0 : least);
    Eigen::VectorXd above = x;
    Eigen::VectorXd below = x;
    above(i) += step;
    below(i) = std::max(number.lowest(), x(i) - step);
    slopes.emplace_back(
        (motion_columns(family.recorded_device(above)) - motion_columns(family.recorded_device(below))) /
        (above(i) - below(i)));
  }
  return slopes;
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
  const auto numbers = static_cast<Eigen::Index>(slopes.size());
  ExponentialWithDerivatives whole = exponential_with_derivatives(square(columns), squares);
  whole.minus_one.diagonal().array() += 1.0;
  LinearStep step{whole.minus_one.topRows(rows), Rows::Zero(rows * size, padded(numbers)), length};
  for (Eigen::Index d = 0; d < numbers; ++d) {
    const Eigen::MatrixXd changes = whole.derivatives[static_cast<std::size_t>(d)].topRows(rows);
    step.slopes.col(d) = changes.reshaped();
  }
  return step;
}

}  // namespace zwidth::internal
