#include "zwidth/model/tip_motion.hpp"

#include <Eigen/QR>

namespace zwidth {
namespace {

// Relative: directions that depend on others to this are sums of them.
constexpr double dependent_direction_below = 1e-9;

using RowByRow = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::MatrixXd matrix(const std::vector<double>& numbers, Eigen::Index rows) {
  return Eigen::Map<const RowByRow>(numbers.data(), rows, static_cast<Eigen::Index>(numbers.size()) / rows);
}

}  // namespace

std::optional<TipMotion> tip_motion_of(const Device& device) {
  const std::optional<Coordinates>& of = device.parameters().coordinates;
  if (!of || !of->tip) return std::nullopt;
  return TipMotion{.mass = matrix(of->mass, static_cast<Eigen::Index>(of->size())),
                   .elements = of->elements,
                   .sensed = matrix(of->tip->sensed, 3),
                   .pushed = matrix(of->tip->pushed, 3),
                   .tip = matrix(of->tip->moved, 3)};
}

Eigen::MatrixXd tip_directions(const TipMotion& motion) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(motion.tip);
  qr.setThreshold(dependent_direction_below);
  const Eigen::MatrixXd basis = qr.householderQ();
  return basis.leftCols(qr.maxPivot() > 0.0 ? qr.rank() : 0);
}

}  // namespace zwidth
