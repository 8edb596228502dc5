#include "stability/tip/limits_at_pose.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "stability/tip/crossover_scan.hpp"
#include "stability/tip/gain_march.hpp"
#include "stability/tip/grasps_at_pose.hpp"
#include "stability/tip/posed_tip.hpp"
#include "zwidth/stability/grasp_limit.hpp"
#include "zwidth/stability/point_wall.hpp"

namespace zwidth {
namespace internal {
namespace {

constexpr double confirmed_to = 1e-6;  // relative, of K

// The scan's least crossover where the loop's poles confirm it; else what their march finds.
NormalLimits limit_with_nobody(const PosedTip& posed, const CrossoverScan& scan, const Eigen::Vector3d& normal) {
  const Eigen::VectorXd along = posed.along(normal).head(posed.directions.cols());
  const CrossoverScan::Found found = scan.least_along(along);
  if (std::isfinite(found.stiffness)) {
    SampledTip plant = posed.plant;
    plant.Gamma1 = (posed.plant.Gamma1 * along).eval();
    if (plant.has_fraction()) plant.Gamma2 = (posed.plant.Gamma2 * along).eval();
    plant.C = (along.transpose() * posed.plant.C).eval();
    const GainLoop loop = stiffness_loop(plant, posed.loop.wall);
    const double gain = found.stiffness / loop.unit;
    if (is_stable(loop, gain * (1.0 - confirmed_to)) && !is_stable(loop, gain * (1.0 + confirmed_to))) {
      return {StiffnessStatus::finite, found.stiffness, found.angle / posed.plant.period};
    }
  }
  const PointWallLimit limit = normal_wall_limit(posed.motion, posed.loop, normal);
  return {limit.status, limit.stiffness, limit.frequency};
}

}  // namespace

struct LimitsAtPose::Scans {
  Scans(TipMotion of, const DeviceParameters& loop, const NormalLimitsOptions& options)
      : motion(std::move(of)), posed(motion, loop), crossovers(posed) {
    if (options.any_grasp) grasps = grasps_of(motion, loop, GraspedPose::beside);
  }
  TipMotion motion;
  PosedTip posed;
  CrossoverScan crossovers;
  std::vector<GraspsAtPose> grasps;
};

LimitsAtPose::LimitsAtPose(const TipMotion& motion, const DeviceParameters& loop, const NormalLimitsOptions& options)
    : scans_(std::make_unique<const Scans>(motion, loop, options)) {}

LimitsAtPose::~LimitsAtPose() = default;

NormalLimits LimitsAtPose::nobody_along(const Eigen::Vector3d& normal) const {
  return limit_with_nobody(scans_->posed, scans_->crossovers, normal);
}

GraspLimit LimitsAtPose::any_grasp_along(const Eigen::Vector3d& normal) const {
  GraspLimit least{.stiffness = std::numeric_limits<double>::infinity()};
  for (const GraspsAtPose& each : scans_->grasps) least = lesser(least, each.quickly_along(normal));
  return least;
}

}  // namespace internal

std::vector<NormalLimits> limits_along(const TipMotion& motion, const DeviceParameters& loop,
                                       const std::vector<Eigen::Vector3d>& normals,
                                       const NormalLimitsOptions& options) {
  const internal::LimitsAtPose at(motion, loop, options);
  std::vector<NormalLimits> limits;
  for (const Eigen::Vector3d& normal : normals) {
    limits.push_back(at.nobody_along(normal));
    if (options.any_grasp) limits.back().any_grasp = at.any_grasp_along(normal);
  }
  return limits;
}

}  // namespace zwidth
