#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "stability/tip/grasp_discs.hpp"
#include "stability/tip/grasp_stiffness.hpp"
#include "stability/tip/scan_angles.hpp"
#include "stability/tip/tip_response.hpp"
#include "stability/tip/tip_states.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth {
namespace {

constexpr double tip_stands_below = 1e-9;  // what the tip moves of a normal

DeviceParameters nobody_holding(DeviceParameters loop) {
  loop.user = {};
  return loop;
}

std::vector<double> frequencies_of(const internal::SampledTip& plant, const internal::GraspDiscs& discs) {
  std::vector<double> frequencies = internal::grasp_angles(plant, discs);
  for (double& each : frequencies) each /= plant.period;
  return frequencies;
}

}  // namespace

struct GraspedPlant::Parts {
  Parts(const TipMotion& motion, const DeviceParameters& with, const Eigen::Vector3d& normal)
      : loop(nobody_holding(with)),
        directions(tip_directions(motion)),
        plant(internal::sampled_tip(internal::tip_coordinates(motion, directions), loop)),
        discs(motion, loop, directions, plant),
        frequencies(frequencies_of(plant, discs)) {
    along.head(directions.cols()) = directions.transpose() * normal.normalized();
    if (along.norm() > tip_stands_below) return;
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::tip_does_not_move,
                                              .evidence = {{"x", normal.x()}, {"y", normal.y()}, {"z", normal.z()}}});
  }

  DeviceParameters loop;
  Eigen::MatrixXd directions;
  internal::SampledTip plant;
  internal::GraspDiscs discs;
  std::vector<double> frequencies;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  // the normal in the tip's directions
};

GraspedPlant::GraspedPlant(const TipMotion& motion, const DeviceParameters& loop, const Eigen::Vector3d& normal)
    : parts_(std::make_shared<const Parts>(motion, loop, normal)) {}

GraspedPlant::Disc GraspedPlant::at(double frequency) const {
  const Eigen::Vector3d& normal = parts_->along;
  const double angle = std::min(frequency * parts_->plant.period, std::numbers::pi);
  if (parts_->discs.is_undamped()) {
    const Eigen::Index m = parts_->directions.cols();
    const Eigen::VectorXd along = normal.head(m);
    return {(along.transpose() * internal::TipResponse(parts_->plant).at(angle) * along).value(),
            std::numeric_limits<double>::infinity()};
  }
  const internal::GraspDiscs::Sample sample = parts_->discs.at(angle);
  return internal::disc_along(sample, internal::others_along(sample, normal), normal);
}

const std::vector<double>& GraspedPlant::frequencies() const { return parts_->frequencies; }

bool GraspedPlant::is_undamped() const { return parts_->discs.is_undamped(); }

}  // namespace zwidth
