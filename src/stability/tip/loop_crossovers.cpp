#include "stability/tip/loop_crossovers.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

#include "eigenvalues.hpp"
#include "linear_systems.hpp"
#include "stability/loop/damper_response.hpp"
#include "stability/margins/delay_margin.hpp"
#include "stability/tip/tip_response.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr double narrowest_interval = 1e-7;  // of the angle
constexpr double least_angle = 1e-6;
constexpr std::size_t most_intervals = 300000;
constexpr double deep_pole = 0.5;  // of smaller size, poles are taken together: those of delays crowd at 0
constexpr int deep_terms = 64;
constexpr double unmoved_pole_below = 1e-11;
constexpr std::uintmax_t most_root_steps = 60;

// T on the circle, and how fast it may change.
class ClosedResponse {
 public:
  ClosedResponse(const SampledTip& plant, const Wall& wall)
      : response_(plant),
        period_(plant.period),
        stiffness_(wall.stiffness.value_or(0.0)),
        damper_{wall.damping, wall.velocity_filter_hz} {
    const GainLoop loop = wall_loop(plant, wall);
    const Eigen::MatrixXd closed = loop.state - loop.input * loop.output;
    const EigenDecomposition of = eigen_decomposition(closed);
    const Eigen::MatrixXcd motions = loop.output * of.right;
    const Eigen::MatrixXcd drives = of.left * loop.input;
    Eigen::MatrixXd power = loop.input;  // (1 + closed)^k B
    std::vector<Eigen::MatrixXcd> deep;  // C (1 + closed)^k B less what the other poles make of it
    for (int k = 0; k < deep_terms; ++k) {
      deep.emplace_back((loop.output * power).cast<Complex>());
      power += closed * power;
    }
    for (Eigen::Index i = 0; i < of.values.size(); ++i) {
      const Complex z = 1.0 + of.values(i);
      const double residue = motions.col(i).norm() * drives.row(i).norm();
      if (std::abs(of.values(i)) < unmoved_pole_below && residue < unmoved_pole_below) continue;
      if (std::abs(z) < deep_pole) continue;
      poles_.push_back({std::arg(z), std::abs(z), residue});
      Eigen::MatrixXcd term = motions.col(i) * drives.row(i);
      for (Eigen::MatrixXcd& each : deep) {
        each -= term;
        term *= z;
      }
    }
    double factor = 1.0;
    for (const Eigen::MatrixXcd& each : deep) deep_slope_ += factor++ * each.norm();
  }

  [[nodiscard]] Eigen::MatrixXcd loop_at(double angle) const {
    return (stiffness_ + damper_response(damper_, period_, angle / period_)) * response_.at(angle);
  }

  [[nodiscard]] Eigen::MatrixXcd at(double angle) const {
    const Eigen::MatrixXcd loop = loop_at(angle);
    Eigen::MatrixXcd closed = loop;
    closed.diagonal().array() += 1.0;
    return solve_complex_columns(closed, loop);
  }

  // An upper bound within an interval.
  [[nodiscard]] double slope(double low, double high) const {
    double sum = deep_slope_;
    for (const Pole& each : poles_) {
      const double off = each.angle >= low && each.angle <= high
                             ? 0.0
                             : std::min(std::abs(std::remainder(each.angle - low, 2.0 * pi)),
                                        std::abs(std::remainder(each.angle - high, 2.0 * pi)));
      const double sine = std::sin(0.5 * off);
      const double gap = 1.0 - each.size;
      sum += each.residue / (gap * gap + 4.0 * each.size * sine * sine);  // |e^{j off} - size|^2
    }
    return sum;
  }

 private:
  struct Pole {
    double angle = 0.0;
    double size = 0.0;
    double residue = 0.0;
  };
  TipResponse response_;
  double period_;
  double stiffness_;
  VirtualDamper damper_;
  std::vector<Pole> poles_;
  double deep_slope_ = 0.0;
};

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

// How near the eigenvalues come to a real part of 1/2, less what the bound may move them.
double clearance(const ClosedResponse& closed, const Interval& within) {
  const double moved = 0.5 * (within.high - within.low) * closed.slope(within.low, within.high);
  const ComplexEigen of = complex_eigen(closed.at(0.5 * (within.low + within.high)));
  const double condition = of.vectors.norm() * of.vectors.inverse().norm();
  return (of.values.array() - 0.5).real().abs().minCoeff() - condition * moved;
}

// Intervals that hold all there is, by rising angle, those that touch as one; nothing beyond most_intervals.
std::optional<std::vector<Interval>> intervals_left(const ClosedResponse& closed) {
  std::vector<Interval> left;
  std::vector<Interval> open{{0.0, pi}};
  for (std::size_t count = 0; !open.empty(); ++count) {
    if (count == most_intervals) return std::nullopt;
    const Interval each = open.back();
    open.pop_back();
    if (clearance(closed, each) > 0.0) continue;
    if (each.high - each.low > narrowest_interval * std::max(each.high, least_angle)) {
      const double middle = 0.5 * (each.low + each.high);
      open.push_back({middle, each.high});
      open.push_back({each.low, middle});
    } else if (!left.empty() && left.back().high == each.low) {
      left.back().high = each.high;
    } else {
      left.push_back(each);
    }
  }
  return left;
}

// l = a / b on Riemann's sphere: a height of 0 where |l| = 1.
Eigen::Vector3d on_sphere(Complex a, Complex b) {
  const Complex along = a * std::conj(b);
  const double size = std::norm(a) + std::norm(b);
  return {2.0 * along.real() / size, 2.0 * along.imag() / size, (std::norm(a) - std::norm(b)) / size};
}

// Eigenvalues l of L by those of T = l / (1 + l): they turn slowly where l is near -1 or large. At -1 itself there is no T.
std::vector<Eigen::Vector3d> loop_eigenvalues(const ClosedResponse& closed, double angle) {
  std::vector<Eigen::Vector3d> points;
  const Eigen::MatrixXcd response = closed.at(angle);
  if (!response.allFinite()) {
    for (const Complex& l : complex_eigenvalues(closed.loop_at(angle))) points.push_back(on_sphere(l, 1.0));
    return points;
  }
  for (const Complex& t : complex_eigenvalues(response)) points.push_back(on_sphere(t, 1.0 - t));
  return points;
}

UnitGainPoint unit_gain_point(double angle, const Eigen::Vector3d& eigenvalue) {
  return {angle, std::atan2(-eigenvalue.y(), -eigenvalue.x())};
}

Eigen::Vector3d nearest_of(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& to) {
  return *std::ranges::min_element(points, {}, [&](const Eigen::Vector3d& each) { return (each - to).squaredNorm(); });
}

void add_points(const ClosedResponse& closed, const Interval& within, std::vector<UnitGainPoint>& points) {
  const double low = std::max(within.low, std::numeric_limits<double>::min());
  const auto at_low = loop_eigenvalues(closed, low);
  const auto at_high = loop_eigenvalues(closed, within.high);
  std::size_t crossings = 0;
  for (const Eigen::Vector3d& first : at_low) {
    const Eigen::Vector3d last = nearest_of(at_high, first);
    if (!(first.z() * last.z() < 0.0)) continue;
    const auto tracked = [&](double angle) {
      const double part = (angle - low) / (within.high - low);
      return nearest_of(loop_eigenvalues(closed, angle), first + part * (last - first));
    };
    std::uintmax_t most = most_root_steps;
    const auto [from, to] =
        boost::math::tools::toms748_solve([&](double angle) { return tracked(angle).z(); }, low, within.high, first.z(),
                                          last.z(), boost::math::tools::eps_tolerance<double>(50), most);
    const double angle = 0.5 * (from + to);
    points.push_back(unit_gain_point(angle, tracked(angle)));
    ++crossings;
  }
  if (crossings > 0) return;
  // An eigenvalue that comes as near as rounding tells: it may cross and come back.
  const auto nearest =
      std::ranges::min_element(at_low, {}, [](const Eigen::Vector3d& each) { return std::abs(each.z()); });
  points.push_back(unit_gain_point(low, *nearest));
  points.push_back(unit_gain_point(within.high, nearest_of(at_high, *nearest)));
}

class DelayedTip final : public DelayedLoop {
 public:
  DelayedTip(const TipCoordinates& of, const DeviceParameters& loop) : of_(of), loop_(loop) {}

  [[nodiscard]] std::vector<UnitGainPoint> points_at(double share) const override {
    auto points = all_unit_gain_points(plant_with(share), loop_.wall);
    if (!points) throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::crossover_off_boundary});
    return *std::move(points);
  }
  [[nodiscard]] double level_at_nyquist(double share) const override {
    const SampledTip plant = plant_with(share);
    const VirtualDamper damper{loop_.wall.damping, loop_.wall.velocity_filter_hz};
    const Complex wall = *loop_.wall.stiffness + damper_response(damper, period(), pi / period());
    double nearest = std::numeric_limits<double>::infinity();
    for (const Complex& each : complex_eigenvalues(wall * TipResponse(plant).at(pi))) {
      const double level = std::log(std::abs(each));
      if (std::abs(level) < std::abs(nearest)) nearest = level;
    }
    return nearest;
  }
  [[nodiscard]] bool has_one_locus() const override { return of_.sensed.rows() == 1; }
  [[nodiscard]] double period() const override { return loop_.loop.sampling_period; }
  [[nodiscard]] double fastest_mode() const override {
    return std::sqrt(std::max(symmetric_eigenvalues(of_.stiffness).maxCoeff(), 0.0));
  }

 private:
  [[nodiscard]] SampledTip plant_with(double share) const {
    DeviceParameters later = loop_;
    later.loop.delay += share * period();
    return sampled_tip(of_, later);
  }

  const TipCoordinates& of_;
  const DeviceParameters& loop_;
};

}  // namespace

std::optional<std::vector<UnitGainPoint>> all_unit_gain_points(const SampledTip& plant, const Wall& wall) {
  const Eigen::Index m = plant.C.rows();
  if (plant.Phi.rows() + m * (plant.delay_samples + 3) > most_states_of_crossovers) return std::nullopt;
  const ClosedResponse closed(plant, wall);
  const auto left = intervals_left(closed);
  if (!left) return std::nullopt;
  std::vector<UnitGainPoint> points;
  for (const Interval& each : *left) add_points(closed, each, points);
  std::ranges::sort(points, {}, &UnitGainPoint::angle);
  return points;
}

std::optional<double> delay_margin_of_tip(const TipCoordinates& of, const DeviceParameters& loop) {
  return least_delay(DelayedTip(of, loop));
}

}  // namespace zwidth::internal
