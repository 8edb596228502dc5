#include "stability/tip/posed_tip.hpp"

#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

DeviceParameters without_user(DeviceParameters loop) {
  loop.user = {};
  return loop;
}

const Eigen::MatrixXd& checked(const Eigen::MatrixXd& directions) {
  if (directions.cols() == 0) throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::tip_stands_still});
  return directions;
}

}  // namespace

PosedTip::PosedTip(const TipMotion& of, const DeviceParameters& with)
    : motion(of),
      loop(without_user(with)),
      directions(tip_directions(of)),
      plant(sampled_tip(tip_coordinates(of, checked(directions)), loop)) {
  require_plain_wall(loop);
}

Eigen::Vector3d PosedTip::along(const Eigen::Vector3d& normal) const {
  require_tip_moves_along(motion, normal);
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  result.head(directions.cols()) = directions.transpose() * normal.normalized();
  return result;
}

}  // namespace zwidth::internal
