#include "zwidth/model/tip_motion.hpp"

#include <Eigen/SVD>

namespace zwidth {
namespace {

using RowByRow = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::MatrixXd matrix(const std::vector<double>& numbers, Eigen::Index rows) {
  return Eigen::Map<const RowByRow>(numbers.data(), rows, static_cast<Eigen::Index>(numbers.size()) / rows);
}

}  // namespace

std::optional<TipMotion> tip_motion_of(const Device& device) {
  const std::optional<Coordinates>& of = device.parameters().coordinates;
  if (!of || !of->tip) return std::nullopt;
  TipMotion motion{.mass = matrix(of->mass, static_cast<Eigen::Index>(of->size())),
                   .elements = of->elements,
                   .sensed = matrix(of->tip->sensed, 3),
                   .pushed = matrix(of->tip->pushed, 3),
                   .tip = {}};
  const Eigen::MatrixXd moved = matrix(of->tip->moved, static_cast<Eigen::Index>(of->tip->moved.size() / of->size()));
  motion.tip = moved.topRows(3);
  for (Eigen::Index row = 3; row < moved.rows(); row += 3) motion.tips_beside.emplace_back(moved.middleRows(row, 3));
  return motion;
}

bool is_of_mechanism(const Device& device) {
  return device.parameters().coordinates && device.parameters().coordinates->tip;
}

Eigen::Vector3d wall_normal(const Device& device) {
  if (!is_of_mechanism(device)) return Eigen::Vector3d::Zero();
  return Eigen::Vector3d(device.parameters().coordinates->tip->normal.data());
}

Eigen::MatrixXd tip_directions(const Eigen::MatrixXd& tip) {
  if (tip.size() == 0) return {tip.rows(), 0};
  Eigen::JacobiSVD<Eigen::MatrixXd> svd;
  svd.setThreshold(tip_stands_below);
  svd.compute(tip, Eigen::ComputeThinU);
  return svd.matrixU().leftCols(svd.singularValues()(0) > 0.0 ? svd.rank() : 0);
}

Eigen::MatrixXd tip_directions(const TipMotion& motion) { return tip_directions(motion.tip); }

bool tip_moves_along(const Eigen::MatrixXd& tip, const Eigen::Vector3d& normal) {
  return (tip.transpose() * normal.normalized()).norm() > tip_stands_below * tip.norm();
}

}  // namespace zwidth
