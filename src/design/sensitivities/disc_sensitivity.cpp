#include "design/sensitivities/disc_sensitivity.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "design/sensitivities/controller_sensitivity.hpp"
#include "design/sensitivities/plant_sensitivity.hpp"
#include "model/device_matrices.hpp"
#include "model/drive_path.hpp"

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;
using Real = long double;
using Number = std::complex<Real>;
using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;
using Kind = DesignParameter::Kind;
using Eigen::Index;
using std::numbers::pi;

constexpr double far_away = 1e8;  // times the last alias summed: where a density has reached its power law

/// g(w) and the derivatives of log g, at the frequency of one alias. In long double: towards w = 0 the rigid motion is
/// a small difference of large stiffnesses, and the discs' condition a small difference of large terms.
class Density {
 public:
  explicit Density(const Device& free)
      : free_(free), matrices_(device_matrices<Real>(free)), drive_(drive_path_of(free.parameters())) {}

  void move_to(Real frequency) {
    frequency_ = frequency;
    const auto n = static_cast<Index>(matrices_.mass.size());
    Matrix impedance(n, n);
    Matrix damping(n, n);
    for (Index i = 0; i < n; ++i) {
      for (Index k = 0; k < n; ++k) {
        const auto entry = static_cast<std::size_t>(i * n + k);
        damping(i, k) = matrices_.damping[entry];
        impedance(i, k) = Number(matrices_.stiffness[entry], frequency * matrices_.damping[entry]);
      }
      impedance(i, i) -= frequency * frequency * matrices_.mass[static_cast<std::size_t>(i)];
    }
    const Eigen::PartialPivLU<Matrix> solver(impedance);
    const Loop& loop = free_.loop();
    const auto unit = [n](std::size_t body) -> Vector { return Vector::Unit(n, static_cast<Index>(body)); };
    q_ = solver.solve(unit(loop.held));
    const Number sensed = q_(static_cast<Index>(loop.sensed));
    const Number actuated = q_(static_cast<Index>(loop.actuated));
    const Vector force = damping * q_.conjugate();
    dissipation_ = (q_.transpose() * force)(0).real();
    through_ = solver.solve(unit(loop.sensed)) / sensed + solver.solve(unit(loop.actuated)) / actuated;
    damped_ = solver.solve(force);
    value_ =
        sensed * actuated * drive_.response<Number>(frequency) / (Real(2.0) * frequency * frequency * dissipation_);
  }

  [[nodiscard]] Number value() const { return value_; }

  [[nodiscard]] Number log_slope(const DesignParameter& parameter) const {
    const Real w = frequency_;
    const auto i = static_cast<Index>(parameter.index);
    switch (parameter.kind) {
      case Kind::body_mass:
        return of_force(-w * w, q_(i), through_(i), damped_(i));
      case Kind::body_damping:
        return of_damper(q_(i), through_(i), damped_(i));
      case Kind::body_stiffness:
        return of_force(Real(1.0), q_(i), through_(i), damped_(i));
      case Kind::link_stiffness:
      case Kind::link_damping: {
        const Link& link = free_.links()[parameter.index];
        const auto a = static_cast<Index>(link.first);
        const auto b = static_cast<Index>(link.second);
        const Number q = q_(a) - q_(b);
        const Number through = through_(a) - through_(b);
        const Number damped = damped_(a) - damped_(b);
        return parameter.kind == Kind::link_stiffness ? of_force(Real(1.0), q, through, damped)
                                                      : of_damper(q, through, damped);
      }
      case Kind::time_constant:
        return Number(Real(0.0), -w) / Number(Real(1.0), Real(drive_.lag) * w);
      case Kind::tracking_bandwidth: {  // of (2 b s + b²)/(s + b)²
        const Real b(drive_.tracking);
        const Number s(Real(0.0), w);
        return Real(2.0) * (s + b) / (b * (Real(2.0) * s + b)) - Real(2.0) / (s + b);
      }
      default:
        return Real(0.0);
    }
  }

 private:
  /// dZ = factor v v^T, from the products of v with q and the adjoint vectors.
  [[nodiscard]] Number of_force(Number factor, Number q, Number through, Number damped) const {
    return -factor * q * through + Real(2.0) * (factor * damped * q).real() / dissipation_;
  }

  [[nodiscard]] Number of_damper(Number q, Number through, Number damped) const {
    return of_force(Number(Real(0.0), frequency_), q, through, damped) - std::norm(q) / dissipation_;
  }

  const Device& free_;
  DeviceMatrices<Real> matrices_;
  DrivePath drive_;
  Real frequency_ = Real(0.0);
  Real dissipation_ = Real(0.0);  // Q
  Number value_;
  Vector q_;
  Vector through_;  // Z^-1 (e_s/q_s + e_a/q_a)
  Vector damped_;   // Z^-1 D conj q
};

Complex rounded(const Number& value) { return {static_cast<double>(value.real()), static_cast<double>(value.imag())}; }

/// The sums over aliases, without the hold and the filters: see TerminationDiscs::summed().
struct Sums {
  Complex shift;
  double radius = 0.0;
  std::vector<Complex> shift_by;
  std::vector<double> radius_by;
  Complex shift_by_delay;
  double far_density = 0.0;  // the limit of w² |g|
};

Sums sums_over_aliases(const Device& free, const TerminationDiscs& discs, double angle,
                       std::span<const DesignParameter> parameters) {
  const double period = free.loop().sampling_period;
  const double delay = free.loop().delay;
  const double frequency = angle / period;
  const double spacing = 2.0 * pi / period;
  const AliasSumQuadrature& rule = discs.rule();
  const AliasSumQuadrature slope = discs.rule_derivative();
  Density density(free);
  Sums sums;
  sums.shift_by.assign(parameters.size(), 0.0);
  sums.radius_by.assign(parameters.size(), 0.0);
  // side +1: aliases at offset + w; -1: at offset - w, whose part is the conjugate.
  const auto add = [&](std::size_t k, double side) {
    const AliasSumQuadrature::Node& node = rule.nodes[k];
    density.move_to(Real(node.number * spacing + side * frequency));
    const Complex value = rounded(density.value());
    const Complex turned = value * std::polar(1.0, -side * frequency * delay);
    const auto facing = [side](Complex part) { return side > 0.0 ? part : std::conj(part); };
    const Complex part = node.turning * turned;
    const double still = node.still * std::abs(value);
    sums.shift += facing(part);
    sums.radius += still;
    sums.shift_by_delay += facing(slope.nodes[k].turning * spacing * turned + part * Complex(0.0, -side * frequency));
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const Complex by = rounded(density.log_slope(parameters[i]));
      sums.shift_by[i] += facing(part * by);
      sums.radius_by[i] += still * by.real();
    }
  };
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    add(k, 1.0);
    if (rule.nodes[k].number != 0.0) add(k, -1.0);
  }
  const double far = far_away * spacing * rule.nodes.back().number;
  density.move_to(Real(far));
  sums.far_density = far * far * std::abs(rounded(density.value()));
  return sums;
}

}  // namespace

DiscSensitivity disc_sensitivity(const Device& free, const TerminationDiscs& discs, double angle,
                                 std::span<const DesignParameter> parameters) {
  const double period = free.loop().sampling_period;
  const double spacing = 2.0 * pi / period;
  const SampledPlant& unfiltered = discs.free_plant();
  const std::complex<double> reference = response(unfiltered, angle / period);
  const PlantSensitivity plant = plant_sensitivity(free, angle, parameters);
  const FilterSensitivity filters = filter_sensitivity(free, angle, parameters);
  const Sums sums = sums_over_aliases(free, discs, angle, parameters);
  const std::complex<double> hold =
      std::polar(2.0 * std::sin(0.5 * angle) / period, 0.5 * (pi - angle));  // (1 - z^-1)/T
  const double hold_size = std::abs(hold);
  const std::complex<double> centre = reference - hold * sums.shift;
  const double radius = hold_size * sums.radius;
  DiscSensitivity sensitivity;
  sensitivity.disc = {filters.value * centre, std::abs(filters.value) * radius};
  std::vector<std::complex<double>>& centre_by = sensitivity.centre_by_parameter;
  std::vector<double>& radius_by = sensitivity.radius_by_parameter;
  std::complex<double> in_time = 0.0;  // what a longer unit of time makes of centre and radius
  double radius_in_time = 0.0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const DesignParameter& each = parameters[i];
    std::complex<double> by = plant.by_parameter[i] - hold * sums.shift_by[i];
    double radius_slope = hold_size * sums.radius_by[i];
    const bool is_new_lag = each.kind == Kind::time_constant && each.value == 0.0;
    if (each.kind == Kind::delay || is_new_lag) by = plant.by_parameter[i] - hold * sums.shift_by_delay;
    // The terms of a lag's growth from 0 fall too slowly to be summed:
    // sum of g0/w_k² (1/sqrt(1 + tau² w_k²) - 1) tends to -tau g0/spacing per side.
    if (is_new_lag) radius_slope = -2.0 * hold_size * sums.far_density / spacing;
    const double power = each.kind == Kind::body_mass ? 2.0
                         : each.kind == Kind::body_damping || each.kind == Kind::link_damping ||
                                 each.kind == Kind::delay || each.kind == Kind::time_constant
                             ? 1.0
                         : each.kind == Kind::tracking_bandwidth ? -1.0
                                                                 : 0.0;
    in_time += power * each.value * by;
    radius_in_time += power * each.value * radius_slope;
    centre_by.push_back(by);
    radius_by.push_back(radius_slope);
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].kind == Kind::sampling_period) {
      centre_by[i] = -in_time / period;
      radius_by[i] = -radius_in_time / period;
    }
    const std::complex<double> filter = filters.log_by_parameter[i];
    centre_by[i] = filters.value * (centre_by[i] + filter * centre);
    radius_by[i] = std::abs(filters.value) * (radius_by[i] + filter.real() * radius);
  }
  return sensitivity;
}

}  // namespace zwidth::internal
