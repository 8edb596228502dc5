#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "stability/loop/damper_response.hpp"
#include "stability/tip/gain_march.hpp"
#include "stability/tip/grasp_search.hpp"
#include "stability/tip/limits_at_pose.hpp"
#include "stability/tip/scan_angles.hpp"
#include "stability/tip/tip_response.hpp"
#include "stability/tip/tip_states.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/grasp_limit.hpp"
#include "zwidth/stability/point_wall.hpp"

namespace zwidth {
namespace {

using internal::GraspSearch;
using internal::SampledTip;
using internal::TipResponse;
using std::numbers::pi;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double lowest_crossover = 1e-5;
constexpr int crossover_angles = 120;
constexpr double confirmed_to = 1e-6;  // relative, of K
constexpr int most_halvings = 80;

VirtualDamper damper_of(const DeviceParameters& loop) { return {loop.wall.damping, loop.wall.velocity_filter_hz}; }

DeviceParameters without_user(DeviceParameters loop) {
  loop.user = {};
  return loop;
}

// What is of the pose.
struct Posed {
  Posed(const TipMotion& of, const DeviceParameters& with)
      : motion(of),
        loop(without_user(with)),
        directions(tip_directions(of)),
        plant(internal::sampled_tip(internal::tip_coordinates(of, checked(directions)), loop)) {
    internal::require_plain_wall(loop);
  }

  static const Eigen::MatrixXd& checked(const Eigen::MatrixXd& directions) {
    if (directions.cols() == 0) throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::tip_stands_still});
    return directions;
  }

  // In the tip's directions, padded with 0.
  [[nodiscard]] Eigen::Vector3d along(const Eigen::Vector3d& normal) const {
    internal::require_tip_moves_along(motion, normal);
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    result.head(directions.cols()) = directions.transpose() * normal.normalized();
    return result;
  }

  TipMotion motion;
  DeviceParameters loop;
  Eigen::MatrixXd directions;
  SampledTip plant;
};

// Any grasp of the tip, with the damper of the wall.
class GraspsAtPose {
 public:
  GraspsAtPose(const TipMotion& motion, const DeviceParameters& loop)
      : posed_(motion, loop),
        search_(posed_.motion, posed_.loop, posed_.directions, posed_.plant),
        wall_(search_.wall([damper = damper_of(posed_.loop), period = posed_.plant.period](double angle) {
          return internal::WallResponse{1.0, internal::damper_response(damper, period, angle / period)};
        })) {}

  [[nodiscard]] GraspLimit along(const Eigen::Vector3d& normal) const {
    return limit_of(GraspSearch::Along(search_, posed_.along(normal)).least(wall_));
  }

  [[nodiscard]] GraspLimit quickly_along(const Eigen::Vector3d& normal) const {
    return limit_of(GraspSearch::Along(search_, posed_.along(normal)).quickly_least(wall_));
  }

  [[nodiscard]] PointGraspLimit of_point() const {
    const auto [least, most] = search_.least_of_point(posed_.directions.cols(), damper_of(posed_.loop));
    return {least.gain, most.gain, limit_of(least).frequency};
  }

 private:
  [[nodiscard]] GraspLimit limit_of(const GraspSearch::Least& least) const {
    return {least.gain, internal::frequency_of(least, posed_.plant.period)};
  }

  Posed posed_;
  GraspSearch search_;
  GraspSearch::Wall wall_;
};

// What users leave: at the pose, or at each of those beside it.
std::vector<GraspsAtPose> grasps_of(const TipMotion& motion, const DeviceParameters& loop, GraspedPose pose) {
  std::vector<GraspsAtPose> grasps;
  if (pose == GraspedPose::alone) {
    grasps.emplace_back(motion, loop);
    return grasps;
  }
  for (const TipMotion& each : internal::grasped_motions(motion)) grasps.emplace_back(each, loop);
  return grasps;
}

// NaN where either is not known.
GraspLimit lesser(const GraspLimit& a, const GraspLimit& b) {
  return b.stiffness < a.stiffness || std::isnan(b.stiffness) ? b : a;
}

// -1/P - B v, which is K where it is real.
class CrossoverScan {
 public:
  explicit CrossoverScan(const Posed& posed)
      : damper_(damper_of(posed.loop)),
        period_(posed.plant.period),
        response_(posed.plant),
        angles_(internal::scan_angles(lowest_crossover, crossover_angles, internal::angles_around(response_.poles()))) {
    for (const double angle : angles_) samples_.push_back(response_.at(angle));
  }

  struct Found {
    double stiffness = infinity;
    double angle = 0.0;
  };
  [[nodiscard]] Found least_along(const Eigen::VectorXd& normal) const {
    std::vector<std::complex<double>> values;
    for (std::size_t i = 0; i < angles_.size(); ++i) values.push_back(stiffness(samples_[i], angles_[i], normal));
    Found least;
    if (values.back().real() > 0.0) least = {values.back().real(), pi};
    for (std::size_t i = 0; i + 2 < values.size(); ++i) {
      if (!(values[i].imag() * values[i + 1].imag() < 0.0)) continue;
      if (values[i].real() < 0.0 && values[i + 1].real() < 0.0) continue;
      const Found found = crossover(normal, angles_[i], values[i], angles_[i + 1], values[i + 1]);
      if (found.stiffness > 0.0 && found.stiffness < least.stiffness) least = found;
    }
    return least;
  }

 private:
  [[nodiscard]] std::complex<double> stiffness(const Eigen::MatrixXcd& plant, double angle,
                                               const Eigen::VectorXd& normal) const {
    const std::complex<double> p = (normal.transpose() * plant * normal).value();
    return -1.0 / p - internal::damper_response(damper_, period_, angle / period_);
  }

  // False position, by which no end stays twice (Illinois).
  [[nodiscard]] Found crossover(const Eigen::VectorXd& normal, double a, std::complex<double> at_a, double b,
                                std::complex<double> at_b) const {
    double fa = at_a.imag();
    double fb = at_b.imag();
    Found found;
    for (int step = 0; step < most_halvings; ++step) {
      found.angle = std::clamp(b - fb * (b - a) / (fb - fa), std::min(a, b), std::max(a, b));
      const std::complex<double> value = stiffness(response_.at(found.angle), found.angle, normal);
      found.stiffness = value.real();
      const bool is_there = value.imag() == 0.0 || std::abs(b - a) <= 4e-15 * b ||
                            std::abs(value.imag()) < 1e-15 * std::abs(value.real());
      if (is_there) break;
      if (value.imag() * fb < 0.0) {
        a = b;
        fa = fb;
      } else {
        fa *= 0.5;
      }
      b = found.angle;
      fb = value.imag();
    }
    return found;
  }

  VirtualDamper damper_;
  double period_;
  TipResponse response_;
  std::vector<double> angles_;
  std::vector<Eigen::MatrixXcd> samples_;
};

NormalLimits nobody_along(const Posed& posed, const CrossoverScan& scan, const Eigen::Vector3d& normal) {
  const Eigen::VectorXd along = posed.along(normal).head(posed.directions.cols());
  const CrossoverScan::Found found = scan.least_along(along);
  if (std::isfinite(found.stiffness)) {
    SampledTip plant = posed.plant;
    plant.Gamma1 = (posed.plant.Gamma1 * along).eval();
    if (plant.has_fraction()) plant.Gamma2 = (posed.plant.Gamma2 * along).eval();
    plant.C = (along.transpose() * posed.plant.C).eval();
    const internal::GainLoop loop = internal::stiffness_loop(plant, posed.loop.wall);
    const double gain = found.stiffness / loop.unit;
    if (internal::is_stable(loop, gain * (1.0 - confirmed_to)) &&
        !internal::is_stable(loop, gain * (1.0 + confirmed_to))) {
      return {StiffnessStatus::finite, found.stiffness, found.angle / posed.plant.period};
    }
  }
  const PointWallLimit limit = normal_wall_limit(posed.motion, posed.loop, normal);
  return {limit.status, limit.stiffness, limit.frequency};
}

}  // namespace

namespace internal {

struct LimitsAtPose::Scans {
  Scans(TipMotion of, const DeviceParameters& loop, const NormalLimitsOptions& options)
      : motion(std::move(of)), posed(motion, loop), crossovers(posed) {
    if (options.any_grasp) grasps = grasps_of(motion, loop, GraspedPose::beside);
  }
  TipMotion motion;
  Posed posed;
  CrossoverScan crossovers;
  std::vector<GraspsAtPose> grasps;
};

LimitsAtPose::LimitsAtPose(const TipMotion& motion, const DeviceParameters& loop, const NormalLimitsOptions& options)
    : scans_(std::make_unique<const Scans>(motion, loop, options)) {}

LimitsAtPose::~LimitsAtPose() = default;

NormalLimits LimitsAtPose::nobody_along(const Eigen::Vector3d& normal) const {
  return zwidth::nobody_along(scans_->posed, scans_->crossovers, normal);
}

GraspLimit LimitsAtPose::any_grasp_along(const Eigen::Vector3d& normal) const {
  GraspLimit least{.stiffness = infinity};
  for (const GraspsAtPose& each : scans_->grasps) least = lesser(least, each.quickly_along(normal));
  return least;
}

}  // namespace internal

GraspLimit any_grasp_limit(const TipMotion& motion, const DeviceParameters& loop, const Eigen::Vector3d& normal,
                           GraspedPose pose) {
  internal::require_tip_moves_along(motion, normal);
  GraspLimit least{.stiffness = infinity};
  for (const GraspsAtPose& each : grasps_of(motion, loop, pose)) least = lesser(least, each.along(normal));
  return least;
}

PointGraspLimit any_grasp_limit_of_point(const TipMotion& motion, const DeviceParameters& loop, GraspedPose pose) {
  PointGraspLimit least{.at_least = infinity, .at_most = infinity};
  for (const GraspsAtPose& each : grasps_of(motion, loop, pose)) {
    const PointGraspLimit here = each.of_point();
    if (here.at_least < least.at_least) {
      least.at_least = here.at_least;
      least.frequency = here.frequency;
    }
    least.at_most = std::min(least.at_most, here.at_most);
  }
  return least;
}

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
