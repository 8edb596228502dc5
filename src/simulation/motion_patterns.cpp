#include <algorithm>
#include <cmath>
#include <utility>

#include "model/balance.hpp"
#include "model/device_matrices.hpp"
#include "sampling/matrix_exponential.hpp"
#include "simulation/continuous_motion.hpp"
#include "zwidth/model/state_space.hpp"

namespace zwidth::internal {
namespace {

/// Pieces over which the bound on a second derivative is taken; more: tighter, costs at construction only.
constexpr int bound_pieces = 16;

/// Of the part that moves: constants (the forces, a stuck body's velocity) have a zero row and only feed the others.
double balanced_norm(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd scales = balancing_scales(matrix);
  const Eigen::MatrixXd balanced = scales.cwiseInverse().asDiagonal() * matrix * scales.asDiagonal();
  double norm = 0.0;
  for (Eigen::Index i = 0; i < matrix.cols(); ++i) {
    if (!matrix.row(i).isZero(0.0)) norm = std::max(norm, balanced.col(i).cwiseAbs().sum());
  }
  return norm;
}

Eigen::MatrixXd exponential(const Eigen::MatrixXd& matrix) {
  return Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()) + exponential_minus_one(matrix);
}

/// How far a functional of the state moves within one piece of a step, at most, and how it is carried to the next.
struct Pieces {
  Eigen::MatrixXd step;    // e^{A piece}
  Eigen::MatrixXd growth;  // e^{|A| piece}
};

Pieces pieces_of(const Eigen::MatrixXd& matrix, double h) {
  const double piece = h / bound_pieces;
  return {exponential(matrix * piece), exponential(matrix.cwiseAbs() * piece)};
}

/// sup over 0 <= t <= h of |row e^{At}|, by component: at the ends of pieces, |row e^{At}| <= |row| e^{|A|t} inside.
Eigen::VectorXd largest_over(const Eigen::RowVectorXd& row, const Pieces& pieces) {
  Eigen::RowVectorXd at = row;
  Eigen::RowVectorXd largest = Eigen::RowVectorXd::Zero(row.size());
  for (int k = 0; k < bound_pieces; ++k) {
    largest = largest.cwiseMax(at.cwiseAbs() * pieces.growth);
    at = at * pieces.step;
  }
  return largest.transpose();
}

/// Where nothing but a constant force moves the device, the series is exact over any time.
constexpr double least_rate = 1e-30;

}  // namespace

Eigen::MatrixXd ContinuousMotion::matrix_of(const Device& device, OutsideForce outside, unsigned stuck) const {
  const auto n = static_cast<Eigen::Index>(size_);
  const auto command = static_cast<Eigen::Index>(command_);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  if (!device.has_bodies()) {
    const ContinuousStateSpace system = state_space(device);
    matrix.topLeftCorner(system.A.rows(), system.A.cols()) = system.A;
    matrix.col(command).head(system.B.size()) = system.B;
    return matrix;
  }
  const auto bodies = static_cast<Eigen::Index>(bodies_);
  const auto parts = device_matrices<double>(device);
  const DeviceParameters& parameters = device.parameters();
  for (Eigen::Index i = 0; i < bodies; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Eigen::Index velocity = bodies + i;
    // q_0' = v_0; (q_i - q_0)' = v_i - v_0
    matrix(i, velocity) = 1.0;
    if (i > 0) matrix(i, bodies) = -1.0;
    // m v' = -k_ground q_0 - sum_j K_ij (q_j - q_0) - sum_j D_ij v_j: the links' stiffness cancels from q_0's column
    const double mass = parts.mass[at];
    const double ground = device.bodies()[at].stiffness + (at == device.loop().held ? parameters.user.stiffness : 0.0);
    matrix(velocity, 0) = -ground / mass;
    for (Eigen::Index j = 0; j < bodies; ++j) {
      const std::size_t entry = at * bodies_ + static_cast<std::size_t>(j);
      if (j > 0) matrix(velocity, j) = -parts.stiffness[entry] / mass;
      matrix(velocity, bodies + j) = -parts.damping[entry] / mass;
    }
    if (at == actuated_) matrix(velocity, lag_ == no_state ? command : static_cast<Eigen::Index>(lag_)) = 1.0 / mass;
    if (outside_ != no_state && at == device.loop().held)
      matrix(velocity, static_cast<Eigen::Index>(outside_)) = 1.0 / mass;
  }
  if (lag_ != no_state) {
    const auto lag = static_cast<Eigen::Index>(lag_);
    matrix(lag, lag) = -1.0 / parameters.actuator.time_constant;
    matrix(lag, command) = 1.0 / parameters.actuator.time_constant;
  }
  if (tracked_ != no_state) {  // p' = w (2 (y - p) + q), q' = w (y - p)
    const auto p = static_cast<Eigen::Index>(tracked_);
    for (const Eigen::Index part : {Eigen::Index{0}, static_cast<Eigen::Index>(sensed_)}) {  // y, once of body 0
      matrix(p, part) = 2.0 * bandwidth_;
      matrix(p + 1, part) = bandwidth_;
    }
    matrix(p, p) = -2.0 * bandwidth_;
    matrix(p, p + 1) = bandwidth_;
    matrix(p + 1, p) = -bandwidth_;
  }
  if (outside_ != no_state) {
    const auto w = static_cast<Eigen::Index>(outside_);
    matrix(w, w + 1) = outside.rise;
    matrix(w + 1, w) = -outside.fall;
  }
  for (std::size_t k = 0; k < friction_.size(); ++k) {
    const auto velocity = static_cast<Eigen::Index>(bodies_ + friction_[k].body);
    if ((stuck >> k & 1u) != 0) {
      matrix.row(velocity).setZero();
    } else {
      matrix(velocity, static_cast<Eigen::Index>(friction_[k].force)) = 1.0 / parts.mass[friction_[k].body];
    }
  }
  return matrix;
}

ContinuousMotion::Pattern ContinuousMotion::pattern_of(Eigen::MatrixXd matrix) {
  const double norm = std::max(balanced_norm(matrix), least_rate);
  return {std::move(matrix), norm, {}};
}

void ContinuousMotion::add_steps(Pattern& pattern, unsigned stuck) const {
  // y: the state with the velocities less that of body 0, so that a stiff link's parts are small where it hardly stretches.
  Eigen::MatrixXd x_of_y = Eigen::MatrixXd::Identity(pattern.matrix.rows(), pattern.matrix.cols());
  Eigen::MatrixXd y_of_x = x_of_y;
  for (std::size_t i = 1; i < bodies_; ++i) {
    x_of_y(static_cast<Eigen::Index>(bodies_ + i), static_cast<Eigen::Index>(bodies_)) = 1.0;
    y_of_x(static_cast<Eigen::Index>(bodies_ + i), static_cast<Eigen::Index>(bodies_)) = -1.0;
  }
  const Eigen::MatrixXd matrix = y_of_x * pattern.matrix * x_of_y;
  const Eigen::MatrixXd second = x_of_y * matrix * matrix;  // x'' = second y
  for (const double h : lengths_) {
    std::vector<Eigen::VectorXd> bend(friction_.size());
    for (std::size_t halving = 0; halving <= halvings_; ++halving) {
      const double part = std::ldexp(h, -static_cast<int>(halving));
      // Shorter than the device's fastest motion the bound falls by h² alone.
      const bool is_long = 2.0 * part * pattern.norm > 1.0;
      if ((halving == 0 || is_long) && !bend.empty()) {
        const Pieces pieces = pieces_of(matrix, part);
        for (std::size_t k = 0; k < friction_.size(); ++k) {
          const auto velocity = static_cast<Eigen::Index>(bodies_ + friction_[k].body);
          const Eigen::RowVectorXd row = (stuck >> k & 1u) != 0
                                             ? Eigen::RowVectorXd(friction_[k].other_forces.transpose() * second)
                                             : Eigen::RowVectorXd(second.row(velocity));
          bend[k] = part * part / 8.0 * largest_over(row, pieces);
        }
      } else {
        for (Eigen::VectorXd& each : bend) each /= 4.0;
      }
      pattern.steps.push_back({exponential(pattern.matrix * part), bend});
    }
  }
}

}  // namespace zwidth::internal
