#include "zwidth/model/state_space.hpp"

#include "model/device_matrices.hpp"
#include "model/normal_coordinates.hpp"

namespace zwidth {
using namespace internal;
namespace {

// Appends the lag as a state: tau F' = F_commanded - F.
ContinuousStateSpace with_lag(const ContinuousStateSpace& system, double time_constant) {
  const Eigen::Index n = system.A.rows();
  ContinuousStateSpace lagged{Eigen::MatrixXd::Zero(n + 1, n + 1), Eigen::VectorXd::Zero(n + 1),
                              Eigen::RowVectorXd::Zero(n + 1)};
  lagged.A.topLeftCorner(n, n) = system.A;
  lagged.A.topRightCorner(n, 1) = system.B;
  lagged.A(n, n) = -1.0 / time_constant;
  lagged.B(n) = 1.0 / time_constant;
  lagged.C.head(n) = system.C;
  return lagged;
}

ContinuousStateSpace of_bodies(const Device& device) {
  const DeviceMatrices<double> matrices = device_matrices<double>(device);
  const auto n = static_cast<Eigen::Index>(matrices.mass.size());
  ContinuousStateSpace system{Eigen::MatrixXd::Zero(2 * n, 2 * n), Eigen::VectorXd::Zero(2 * n),
                              Eigen::RowVectorXd::Zero(2 * n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const double mass = matrices.mass[static_cast<std::size_t>(i)];
    system.A(i, n + i) = 1.0;
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto entry = static_cast<std::size_t>(i * n + j);
      system.A(n + i, j) = -matrices.stiffness[entry] / mass;
      system.A(n + i, n + j) = -matrices.damping[entry] / mass;
    }
  }
  const std::size_t actuated = device.loop().actuated;
  system.B(n + static_cast<Eigen::Index>(actuated)) = 1.0 / matrices.mass[actuated];
  system.C(static_cast<Eigen::Index>(device.loop().sensed)) = 1.0;
  return system;
}

// In normal coordinates, in which what no spring holds has no stiffness at all. Where the position tells nothing of such a
// motion, its own position is no state, and where no damper holds it its velocity is none: a wall leaves it free.
ContinuousStateSpace of_coordinates(const Device& device) {
  const NormalCoordinates normal = normal_coordinates(device);
  const Eigen::RowVectorXd sensed = normal.of(weights_of(device, device.loop().sensed)).transpose();
  const auto [turn, unseen, adrift] = unseen_first(normal, sensed);
  const Eigen::Index positions = sensed.size() - unseen;
  const Eigen::Index velocities = sensed.size() - adrift;
  const Eigen::Index n = positions + velocities;
  ContinuousStateSpace system{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), Eigen::RowVectorXd::Zero(n)};
  system.A.topRightCorner(positions, positions).setIdentity();
  system.A.bottomLeftCorner(velocities, positions) =
      -(turn.transpose() * normal.stiffness * turn).bottomRightCorner(velocities, positions);
  system.A.bottomRightCorner(velocities, velocities) =
      -(turn.transpose() * normal.damping * turn).bottomRightCorner(velocities, velocities);
  system.B.tail(velocities) =
      (turn.transpose() * normal.of(weights_of(device, device.loop().actuated))).tail(velocities);
  system.C.head(positions) = (sensed * turn).tail(positions);
  return system;
}

ContinuousStateSpace of_transfer_function(const TransferFunction& transfer_function) {
  const std::vector<double>& denominator = transfer_function.denominator;
  const std::vector<double>& numerator = transfer_function.numerator;
  const auto n = static_cast<Eigen::Index>(denominator.size()) - 1;
  ContinuousStateSpace system{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), Eigen::RowVectorXd::Zero(n)};
  for (Eigen::Index i = 0; i + 1 < n; ++i) system.A(i, i + 1) = 1.0;
  for (Eigen::Index i = 0; i < n; ++i) {  // ascending powers
    system.A(n - 1, i) = -denominator[static_cast<std::size_t>(n - i)] / denominator[0];
  }
  system.B(n - 1) = 1.0;
  for (std::size_t i = 0; i < numerator.size() && i < static_cast<std::size_t>(n); ++i) {
    system.C(static_cast<Eigen::Index>(i)) = numerator[numerator.size() - 1 - i] / denominator[0];
  }
  return system;
}

// Appends the drive's tracking as states p and q: p' = w (2 (y - p) + q), q' = w (y - p); p is read.
ContinuousStateSpace with_tracking(const ContinuousStateSpace& system, double bandwidth) {
  const Eigen::Index n = system.A.rows();
  ContinuousStateSpace tracked{Eigen::MatrixXd::Zero(n + 2, n + 2), Eigen::VectorXd::Zero(n + 2),
                               Eigen::RowVectorXd::Zero(n + 2)};
  tracked.A.topLeftCorner(n, n) = system.A;
  tracked.A.bottomLeftCorner(2, n) << 2.0 * bandwidth * system.C, bandwidth * system.C;
  tracked.A.bottomRightCorner(2, 2) << -2.0 * bandwidth, bandwidth, -bandwidth, 0.0;
  tracked.B.head(n) = system.B;
  tracked.C(n) = 1.0;
  return tracked;
}

}  // namespace

ContinuousStateSpace state_space(const Device& device) {
  ContinuousStateSpace system = device.has_bodies()      ? of_bodies(device)
                                : device.is_mechanical() ? of_coordinates(device)
                                                         : of_transfer_function(*device.parameters().transfer_function);
  const double lag = device.parameters().actuator.time_constant;
  if (lag > 0.0) system = with_lag(system, lag);
  const double bandwidth = device.parameters().sensor.tracking_bandwidth;
  return bandwidth > 0.0 ? with_tracking(system, bandwidth) : system;
}

}  // namespace zwidth
