#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>

#include "stability/tip/grasp_discs.hpp"
#include "stability/tip/grasp_stiffness.hpp"
#include "stability/tip/scan_angles.hpp"
#include "stability/tip/tip_response.hpp"
#include "stability/tip/tip_states.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth {
namespace {

DeviceParameters nobody_holding(DeviceParameters loop) {
  loop.user = {};
  return loop;
}

// The plant whose tip is grasped in the directions of a motion.
struct GraspedMotion {
  GraspedMotion(const TipMotion& motion, const DeviceParameters& loop, const Eigen::Vector3d& normal)
      : directions(tip_directions(motion)),
        plant(internal::sampled_tip(internal::tip_coordinates(motion, directions), loop)),
        discs(motion, loop, directions, plant),
        angles(internal::grasp_angles(plant, discs)) {
    along.head(directions.cols()) = directions.transpose() * normal.normalized();
  }

  [[nodiscard]] GraspedPlant::Disc at(double angle) const {
    if (discs.is_undamped()) {
      const Eigen::VectorXd wall = along.head(directions.cols());
      return {(wall.transpose() * internal::TipResponse(plant).at(angle) * wall).value(),
              std::numeric_limits<double>::infinity()};
    }
    const internal::GraspDiscs::Sample sample = discs.at(angle);
    return internal::disc_along(sample, internal::others_along(sample, along), along);
  }

  Eigen::MatrixXd directions;
  internal::SampledTip plant;
  internal::GraspDiscs discs;
  std::vector<double> angles;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  // the normal in the tip's directions
};

// The least disc that holds both.
GraspedPlant::Disc around(const GraspedPlant::Disc& a, const GraspedPlant::Disc& b) {
  const double apart = std::abs(b.centre - a.centre);
  if (!(apart + b.radius > a.radius)) return a;
  if (!(apart + a.radius > b.radius)) return b;
  const double radius = 0.5 * (apart + a.radius + b.radius);
  return {a.centre + (radius - a.radius) / apart * (b.centre - a.centre), radius};
}

}  // namespace

struct GraspedPlant::Parts {
  Parts(const TipMotion& motion, const DeviceParameters& with, const Eigen::Vector3d& normal)
      : period(with.loop.sampling_period) {
    internal::require_tip_moves_along(motion, normal);
    for (const TipMotion& each : internal::grasped_motions(motion)) {
      const GraspedMotion& grasped = motions.emplace_back(each, nobody_holding(with), normal);
      for (const double angle : grasped.angles) frequencies.push_back(angle / period);
    }
    std::ranges::sort(frequencies);
    frequencies.erase(std::unique(frequencies.begin(), frequencies.end()), frequencies.end());
  }

  double period;
  std::vector<GraspedMotion> motions;
  std::vector<double> frequencies;
};

GraspedPlant::GraspedPlant(const TipMotion& motion, const DeviceParameters& loop, const Eigen::Vector3d& normal)
    : parts_(std::make_shared<const Parts>(motion, loop, normal)) {}

GraspedPlant::Disc GraspedPlant::at(double frequency) const {
  const double angle = std::min(frequency * parts_->period, std::numbers::pi);
  Disc disc = parts_->motions.front().at(angle);
  for (std::size_t i = 1; i < parts_->motions.size(); ++i) disc = around(disc, parts_->motions[i].at(angle));
  return disc;
}

const std::vector<double>& GraspedPlant::frequencies() const { return parts_->frequencies; }

bool GraspedPlant::is_undamped() const {
  return std::ranges::any_of(parts_->motions, [](const GraspedMotion& each) { return each.discs.is_undamped(); });
}

}  // namespace zwidth
