#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "stability/loop/damper_response.hpp"
#include "stability/tip/gain_march.hpp"
#include "stability/tip/grasp_discs.hpp"
#include "stability/tip/grasp_stiffness.hpp"
#include "stability/tip/limits_at_pose.hpp"
#include "stability/tip/scan_angles.hpp"
#include "stability/tip/tip_response.hpp"
#include "stability/tip/tip_states.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/grasp_limit.hpp"
#include "zwidth/stability/point_wall.hpp"

namespace zwidth {
namespace {

using internal::GraspDiscs;
using internal::OthersAlong;
using internal::SampledTip;
using internal::TipResponse;
using std::numbers::pi;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double at_low_end = 1.001;  // times the lowest angle of the scan over grasps
constexpr double lowest_crossover = 1e-5;
constexpr int crossover_angles = 120;
constexpr double confirmed_to = 1e-6;  // relative, of K
constexpr int most_halvings = 80;
constexpr double worth_refining = 1.3;  // times the least of the scan
constexpr int exact_bits = 26;
constexpr int quick_bits = 14;

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

struct Minimum {
  double value = infinity;
  double angle = 0.0;
};

// The least of a function whose samples at rising angles are given: lows of the scan are refined.
template <typename Function>
Minimum refined_minimum(const std::vector<double>& angles, const std::vector<double>& values, int bits,
                        const Function& function) {
  const auto scanned = std::ranges::min_element(values);
  Minimum least{*scanned, angles[static_cast<std::size_t>(scanned - values.begin())]};
  const double scan = least.value;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, values.size() - 1);
    const bool is_low = values[i] <= values[before] && values[i] <= values[after] && values[i] <= worth_refining * scan;
    if (!is_low || !(scan > 0.0) || !std::isfinite(scan)) continue;
    std::uintmax_t most = 60;
    const auto found = boost::math::tools::brent_find_minima(
        [&](double angle) {
          const double value = function(i, angle);
          return std::isfinite(value) ? value : std::numeric_limits<double>::max();
        },
        angles[before], angles[after], bits, most);
    if (found.second < least.value) least = {found.second, found.first};
  }
  return least;
}

class GraspScan {
 public:
  explicit GraspScan(Posed of)
      : posed_(std::move(of)),
        period_(posed_.plant.period),
        damper_(damper_of(posed_.loop)),
        discs_(posed_.motion, posed_.loop, posed_.directions, posed_.plant) {
    if (discs_.is_undamped()) return;
    angles_ = internal::grasp_angles(posed_.plant, discs_);
    for (const double angle : angles_) samples_.push_back(discs_.at(angle));
  }

  [[nodiscard]] GraspLimit along(const Eigen::Vector3d& wall) const {
    const Eigen::Vector3d normal = posed_.along(wall);
    return least_along(normal, exact_bits, [&](std::size_t, double angle, const std::vector<OthersAlong>&) {
      const GraspDiscs::Sample sample = discs_.at(angle);
      return internal::least_stiffness_along(sample, internal::others_along(sample, normal), normal, damper_, period_);
    });
  }

  // What the other aliases add, by a parabola through the scan.
  [[nodiscard]] GraspLimit quickly_along(const Eigen::Vector3d& wall) const {
    const Eigen::Vector3d normal = posed_.along(wall);
    return least_along(normal, quick_bits, [&](std::size_t i, double angle, const std::vector<OthersAlong>& others) {
      return internal::least_stiffness_along(discs_.own_at(angle), interpolated(others, i, angle), normal, damper_,
                                             period_);
    });
  }

  [[nodiscard]] PointGraspLimit of_point() const {
    if (discs_.is_undamped()) return {};
    const Eigen::Index m = posed_.directions.cols();
    const auto at = [&](const GraspDiscs::Sample& sample) {
      return internal::least_stiffness_of_point(sample, m, damper_, period_);
    };
    std::vector<double> lower;
    std::vector<double> upper;
    for (const GraspDiscs::Sample& sample : samples_) {
      const internal::PointStiffness point = at(sample);
      lower.push_back(point.at_least);
      upper.push_back(point.at_most);
    }
    const Minimum least = refined_minimum(angles_, lower, exact_bits,
                                          [&](std::size_t, double angle) { return at(discs_.at(angle)).at_least; });
    const Minimum most = refined_minimum(angles_, upper, exact_bits,
                                         [&](std::size_t, double angle) { return at(discs_.at(angle)).at_most; });
    return {least.value, most.value, frequency_of(least)};
  }

 private:
  template <typename Function>
  [[nodiscard]] GraspLimit least_along(const Eigen::Vector3d& normal, int bits, const Function& function) const {
    if (discs_.is_undamped()) return {};
    std::vector<OthersAlong> others;
    std::vector<double> values;
    for (const GraspDiscs::Sample& sample : samples_) {
      others.push_back(internal::others_along(sample, normal));
      values.push_back(internal::least_stiffness_along(sample, others.back(), normal, damper_, period_));
    }
    const Minimum least =
        refined_minimum(angles_, values, bits, [&](std::size_t i, double angle) { return function(i, angle, others); });
    return {least.value, least.value > 0.0 && std::isfinite(least.value) ? frequency_of(least) : 0.0};
  }

  // 0 where the scan is least at its low end.
  [[nodiscard]] double frequency_of(const Minimum& least) const {
    return least.angle > at_low_end * angles_.front() ? least.angle / period_ : 0.0;
  }

  [[nodiscard]] OthersAlong interpolated(const std::vector<OthersAlong>& others, std::size_t near, double angle) const {
    const std::size_t first = std::clamp<std::size_t>(near, 1, angles_.size() - 2) - 1;
    OthersAlong sum;
    for (std::size_t i = first; i < first + 3; ++i) {
      double share = 1.0;
      for (std::size_t j = first; j < first + 3; ++j) {
        if (j != i) share *= (angle - angles_[j]) / (angles_[i] - angles_[j]);
      }
      sum.shift += share * others[i].shift;
      sum.radius += share * others[i].radius;
    }
    sum.radius = std::max(sum.radius, 0.0);
    return sum;
  }

  Posed posed_;
  double period_;
  VirtualDamper damper_;
  GraspDiscs discs_;
  std::vector<double> angles_;
  std::vector<GraspDiscs::Sample> samples_;
};

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

// What users leave: at the pose, or at each of those beside it.
std::vector<GraspScan> grasp_scans(const TipMotion& motion, const DeviceParameters& loop, GraspedPose pose) {
  std::vector<GraspScan> scans;
  if (pose == GraspedPose::alone) return {GraspScan(Posed(motion, loop))};
  for (const TipMotion& each : internal::grasped_motions(motion)) scans.emplace_back(Posed(each, loop));
  return scans;
}

GraspLimit lesser(const GraspLimit& a, const GraspLimit& b) { return b.stiffness < a.stiffness ? b : a; }

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
  Scans(const TipMotion& of, const DeviceParameters& loop, const NormalLimitsOptions& options)
      : motion(of), posed(motion, loop), crossovers(posed) {
    if (options.any_grasp) grasps = grasp_scans(motion, loop, GraspedPose::beside);
  }
  TipMotion motion;
  Posed posed;
  CrossoverScan crossovers;
  std::vector<GraspScan> grasps;
};

LimitsAtPose::LimitsAtPose(const TipMotion& motion, const DeviceParameters& loop, const NormalLimitsOptions& options)
    : scans_(std::make_unique<const Scans>(motion, loop, options)) {}

LimitsAtPose::~LimitsAtPose() = default;

NormalLimits LimitsAtPose::nobody_along(const Eigen::Vector3d& normal) const {
  return zwidth::nobody_along(scans_->posed, scans_->crossovers, normal);
}

GraspLimit LimitsAtPose::any_grasp_along(const Eigen::Vector3d& normal) const {
  GraspLimit least{.stiffness = infinity};
  for (const GraspScan& each : scans_->grasps) least = lesser(least, each.quickly_along(normal));
  return least;
}

}  // namespace internal

GraspLimit any_grasp_limit(const TipMotion& motion, const DeviceParameters& loop, const Eigen::Vector3d& normal,
                           GraspedPose pose) {
  internal::require_tip_moves_along(motion, normal);
  GraspLimit least{.stiffness = infinity};
  for (const GraspScan& each : grasp_scans(motion, loop, pose)) least = lesser(least, each.along(normal));
  return least;
}

PointGraspLimit any_grasp_limit_of_point(const TipMotion& motion, const DeviceParameters& loop, GraspedPose pose) {
  PointGraspLimit least{.at_least = infinity, .at_most = infinity};
  for (const GraspScan& each : grasp_scans(motion, loop, pose)) {
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
