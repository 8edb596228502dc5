#include <utility>
#include <vector>

#include "zwidth/mechanism.hpp"

namespace zwidth {
namespace {

// Relative: along such an axis the tip stands still.
constexpr double axis_stands_still = 1e-9;

Eigen::RowVectorXd weights_of_point(const Device& device, std::size_t point) {
  const std::vector<double>& weights = device.parameters().coordinates->points[point].weights;
  return Eigen::Map<const Eigen::RowVectorXd>(weights.data(), static_cast<Eigen::Index>(weights.size()));
}

}  // namespace

TipMotion tip_motion(const MechanismAtPose& mechanism) {
  TipMotion motion;
  motion.mass = mechanism.mass;
  motion.elements = mechanism.elements;
  motion.sensed = motion.pushed = motion.tip = Eigen::MatrixXd::Zero(3, mechanism.mass.cols());
  DeviceParameters parameters;
  parameters.loop.sampling_period = 1.0;  // nothing depends on it
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (!(mechanism.tip.row(axis).norm() > axis_stands_still * mechanism.tip.norm())) continue;
    const Device along = device_along(mechanism, Eigen::Vector3d::Unit(axis), parameters);
    motion.sensed.row(axis) = weights_of_point(along, along.loop().sensed);
    motion.pushed.row(axis) = weights_of_point(along, along.loop().actuated);
    motion.tip.row(axis) = weights_of_point(along, along.loop().held);
  }
  return motion;
}

}  // namespace zwidth
