#include "mechanism/singular_pose.hpp"

#include "linear_systems.hpp"

namespace zwidth::internal {
namespace {

constexpr double no_slope_below = 1e-3;  // of the slope of J
constexpr double same_rows = 1e-4;
constexpr double rounding_below = 1e-9;  // of J: no joint turns it by less

// Orthonormal rows.
Eigen::MatrixXd row_space(const Eigen::MatrixXd& tip) {
  return orthonormal_basis(tip.transpose(), tip_stands_below).transpose();
}

// What every coordinate moves: the same of each pose, whatever coordinates its loops leave.
Eigen::MatrixXd seen_motions(const MechanismAtPose& at) {
  Eigen::MatrixXd rows(at.joint_motions.rows() + at.motors.rows(), at.mass.cols());
  rows << at.joint_motions, at.motors;
  return rows;
}

// J of another pose in this one's coordinates.
Eigen::MatrixXd tip_in_coordinates_of(const MechanismAtPose& at, const MechanismAtPose& other) {
  return other.tip * least_squares_of_columns(seen_motions(other), seen_motions(at));
}

}  // namespace

void add_tip_beside(MechanismAtPose& at, const MechanismAtPose& before, const MechanismAtPose& after) {
  const Eigen::MatrixXd change = tip_in_coordinates_of(at, after) - tip_in_coordinates_of(at, before);
  const Eigen::MatrixXd directions = tip_directions(at.tip);
  const Eigen::MatrixXd lost = Eigen::Matrix3d::Identity() - directions * directions.transpose();
  const Eigen::MatrixXd own = row_space(at.tip);
  Eigen::MatrixXd gained = lost * change;
  gained -= gained * own.transpose() * own;
  if (!(change.norm() > rounding_below * at.tip.norm()) || !(gained.norm() > no_slope_below * change.norm())) return;
  const Eigen::MatrixXd tip = directions * directions.transpose() * at.tip + at.tip.norm() / gained.norm() * gained;
  const Eigen::MatrixXd rows = row_space(tip);
  for (const Eigen::MatrixXd& each : at.tips_beside) {
    const Eigen::MatrixXd known = row_space(each);
    if (known.rows() == rows.rows() && (rows - rows * known.transpose() * known).norm() < same_rows) return;
  }
  at.tips_beside.push_back(tip);
}

}  // namespace zwidth::internal
