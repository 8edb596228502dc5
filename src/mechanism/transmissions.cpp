#include "mechanism/transmissions.hpp"

#include <utility>
#include <vector>

#include "linear_systems.hpp"

namespace zwidth::internal {
namespace {

// Relative: what rounding leaves of a motion that loops hold, as a tendon of fixed length.
constexpr double fixed_below = 1e-9;

void add_row(Eigen::MatrixXd& rows, const Eigen::VectorXd& row) {
  rows.conservativeResize(rows.rows() + 1, row.size());
  rows.bottomRows(1) = row.transpose();
}

void add_element(MechanismAtPose& mechanism, const Eigen::VectorXd& along, double stiffness, double damping) {
  if ((stiffness == 0.0 && damping == 0.0) || along.isZero(0.0)) return;
  mechanism.elements.push_back({{along.begin(), along.end()}, stiffness, damping});
}

// One more coordinate, of which nothing depends yet.
void add_coordinate(MechanismAtPose& mechanism, double inertia) {
  const Eigen::Index n = mechanism.mass.rows();
  mechanism.mass.conservativeResizeLike(Eigen::MatrixXd::Zero(n + 1, n + 1));
  mechanism.mass(n, n) = inertia;
  for (Coordinates::Element& each : mechanism.elements) each.weights.push_back(0.0);
  for (Coordinates::Friction& each : mechanism.frictions) each.weights.push_back(0.0);
  for (Eigen::MatrixXd* rows :
       {&mechanism.cables, &mechanism.motors, &mechanism.encoders, &mechanism.tip, &mechanism.joint_motions}) {
    rows->conservativeResizeLike(Eigen::MatrixXd::Zero(rows->rows(), n + 1));
  }
}

}  // namespace

Eigen::Index rank_of(const Eigen::MatrixXd& rows) {
  return rows.rows() == 0 ? 0 : rank(rows.rowwise().normalized().transpose(), dependent_below);
}

void add_transmission(MechanismAtPose& mechanism, Eigen::Index joint, const Transmission& motor, bool is_read) {
  if (motor.stiffness == 0.0) {
    const Eigen::VectorXd turns = motor.ratio * Eigen::VectorXd::Unit(mechanism.mass.rows(), joint);
    mechanism.mass(joint, joint) += motor.ratio * motor.ratio * motor.inertia;
    add_element(mechanism, turns, 0.0, motor.motor_damping);
    add_row(mechanism.motors, turns);
    if (is_read) add_row(mechanism.encoders, turns);
    return;
  }
  add_coordinate(mechanism, motor.inertia);
  const Eigen::Index n = mechanism.mass.rows();
  const Eigen::VectorXd turns = Eigen::VectorXd::Unit(n, n - 1);
  const Eigen::VectorXd stretch = turns / motor.ratio - Eigen::VectorXd::Unit(n, joint);
  add_element(mechanism, turns, 0.0, motor.motor_damping);
  add_element(mechanism, stretch, motor.stiffness, motor.damping);
  add_row(mechanism.cables, stretch);
  add_row(mechanism.motors, turns);
  if (is_read) add_row(mechanism.encoders, turns);
}

MechanismAtPose with_loops(const MechanismAtPose& mechanism, const Eigen::MatrixXd& free_motions) {
  MechanismAtPose result;
  result.mass = free_motions.transpose() * mechanism.mass * free_motions;
  const auto in_free_motions = [&free_motions](const Eigen::MatrixXd& rows) -> Eigen::MatrixXd {
    Eigen::MatrixXd free = rows * free_motions;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      if (free.row(i).norm() <= fixed_below * rows.row(i).norm()) free.row(i).setZero();
    }
    return free;
  };
  const auto along = [&in_free_motions](const std::vector<double>& weights) -> Eigen::VectorXd {
    const auto count = static_cast<Eigen::Index>(weights.size());
    return in_free_motions(Eigen::Map<const Eigen::RowVectorXd>(weights.data(), count)).transpose();
  };
  for (const auto& [weights, stiffness, damping] : mechanism.elements) {
    add_element(result, along(weights), stiffness, damping);
  }
  for (const auto& [weights, force] : mechanism.frictions) {
    const Eigen::VectorXd free = along(weights);
    if (free.isZero(0.0)) continue;
    result.frictions.push_back({{free.begin(), free.end()}, force});
  }
  result.cables.resize(0, free_motions.cols());
  const Eigen::MatrixXd cables = in_free_motions(mechanism.cables);
  for (Eigen::Index i = 0; i < cables.rows(); ++i) {
    if (!cables.row(i).isZero(0.0)) add_row(result.cables, cables.row(i).transpose());
  }
  result.motors = in_free_motions(mechanism.motors);
  result.encoders = in_free_motions(mechanism.encoders);
  result.tip = mechanism.tip * free_motions;
  result.joint_motions = mechanism.joint_motions * free_motions;
  result.joints = mechanism.joints;
  result.tip_position = mechanism.tip_position;
  return result;
}

MechanismAtPose without_springs(MechanismAtPose mechanism) {
  Eigen::MatrixXd fixed = mechanism.motors;
  std::vector<Eigen::Index> cables;
  for (Eigen::Index i = mechanism.cables.rows(); i-- > 0;) {
    Eigen::MatrixXd with = fixed;
    add_row(with, mechanism.cables.row(i).transpose());
    if (rank_of(with) == rank_of(fixed)) continue;
    fixed = std::move(with);
    cables.insert(cables.begin(), i);
  }
  mechanism.cables = Eigen::MatrixXd(mechanism.cables(cables, Eigen::all));
  return mechanism;
}

}  // namespace zwidth::internal
