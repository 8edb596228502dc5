#include "design/sensitivities/plant_sensitivity.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "design/sensitivities/exponential_gradient.hpp"
#include "model/balance.hpp"
#include "model/device_matrices.hpp"
#include "sampling/sampling_instants.hpp"
#include "zwidth/model/state_space.hpp"

namespace zwidth::internal {
namespace {

using Eigen::Index;
using Kind = DesignParameter::Kind;

constexpr double agreement = 1e-10;  // of the two routes to P; beyond, long double
// The rigid motion is (angle / |M| T)² of the stiffest terms: what rounding may leave of it before long double.
constexpr double most_lost = 1e-11;
constexpr Index small_size = 8;  // of M: no heap up to here

/// M = [A B; 0 0] and C of the device, in coordinates scaled by powers of two so that M's rows and columns balance.
template <typename P>
struct Generator {
  typename P::Matrix m;       // (n + 1) x (n + 1)
  typename P::Vector output;  // C, n
  typename P::Vector scales;  // n + 1: physical state = scales * state
};

template <typename P>
typename P::Matrix generator_of_bodies(const Device& device) {
  using Real = typename P::Real;
  const DeviceMatrices<Real> matrices = device_matrices<Real>(device);
  const double lag = device.parameters().actuator.time_constant;
  const double bandwidth = device.parameters().sensor.tracking_bandwidth;
  const auto n = static_cast<Index>(matrices.mass.size());
  const Index before = 2 * n + (lag > 0.0 ? 1 : 0);  // the states of the tracking
  const Index states = before + (bandwidth > 0.0 ? 2 : 0);
  typename P::Matrix m = P::Matrix::Zero(states + 1, states + 1);
  for (Index i = 0; i < n; ++i) {
    const Real mass = matrices.mass[static_cast<std::size_t>(i)];
    m(i, n + i) = Real(1.0);
    for (Index j = 0; j < n; ++j) {
      const auto entry = static_cast<std::size_t>(i * n + j);
      m(n + i, j) = -matrices.stiffness[entry] / mass;
      m(n + i, n + j) = -matrices.damping[entry] / mass;
    }
  }
  const auto actuated = static_cast<Index>(device.loop().actuated);
  // The force is the input, or the lag's state beside it.
  m(n + actuated, lag > 0.0 ? 2 * n : states) = Real(1.0) / matrices.mass[device.loop().actuated];
  if (lag > 0.0) {
    m(2 * n, 2 * n) = Real(-1.0) / Real(lag);
    m(2 * n, states) = Real(1.0) / Real(lag);
  }
  if (bandwidth > 0.0) {  // as state_space()
    const auto sensed = static_cast<Index>(device.loop().sensed);
    const Real w(bandwidth);
    m(before, sensed) = Real(2.0) * w;
    m(before, before) = Real(-2.0) * w;
    m(before, before + 1) = w;
    m(before + 1, sensed) = w;
    m(before + 1, before) = -w;
  }
  return m;
}

template <typename P>
Generator<P> generator_of(const Device& device) {
  require_no_coordinates(device);
  using Real = typename P::Real;
  Generator<P> result;
  if (device.has_bodies()) {
    result.m = generator_of_bodies<P>(device);
    result.output = P::Vector::Zero(result.m.rows() - 1);
    const bool is_tracked = device.parameters().sensor.tracking_bandwidth > 0.0;
    result.output(is_tracked ? result.output.size() - 2 : static_cast<Index>(device.loop().sensed)) = Real(1.0);
  } else {
    const ContinuousStateSpace system = state_space(device);
    const Index n = system.A.rows();
    result.m = P::Matrix::Zero(n + 1, n + 1);
    result.m.topLeftCorner(n, n) = system.A.template cast<Real>();
    result.m.topRightCorner(n, 1) = system.B.template cast<Real>();
    result.output = system.C.transpose().template cast<Real>();
  }
  const Index n = result.m.rows() - 1;
  const Eigen::MatrixXd dynamics = result.m.topLeftCorner(n, n).template cast<double>();
  const Eigen::VectorXd balanced = balancing_scales(dynamics);
  result.scales = P::Vector::Ones(n + 1);
  for (Index i = 0; i < n; ++i) result.scales(i) = Real(balanced(i));
  const auto scaled_entry = [&](Index i, Index j) { return result.m(i, j) * result.scales(j) / result.scales(i); };
  for (Index i = 0; i <= n; ++i) {
    for (Index j = 0; j <= n; ++j) {
      if (i != j) result.m(i, j) = scaled_entry(i, j);
    }
  }
  // The input's scale is free: its column as large as the rest.
  const Real size = result.m.topLeftCorner(n, n).cwiseAbs().maxCoeff();
  const Real input = result.m.topRightCorner(n, 1).cwiseAbs().maxCoeff();
  if (size > Real(0.0) && input > Real(0.0)) {
    const Real factor = std::exp2(std::round(std::log2(size / input)));
    result.m.topRightCorner(n, 1) *= factor;
    result.scales(n) = factor;
  }
  // What the input's column gains the output loses.
  for (Index i = 0; i < n; ++i) result.output(i) *= result.scales(i) / result.scales(n);
  return result;
}

template <typename P>
class PlantDerivatives {
 public:
  using Real = typename P::Real;
  using Complex = typename P::Complex;
  using Matrix = typename P::Matrix;
  using ComplexVector = typename P::ComplexVector;
  using ComplexMatrix = typename P::ComplexMatrix;

  PlantDerivatives(const Device& device, double angle)
      : device_(device),
        generator_(generator_of<P>(device)),
        instants_(sampling_instants({device.loop().sampling_period, device.loop().delay})),
        n_(generator_.m.rows() - 1) {
    const Real half = std::sin(Real(angle) / Real(2.0));
    const Real sine = std::sin(Real(angle));
    delta_ = {Real(-2.0) * half * half, sine};
    back_ = std::conj(Complex(Real(1.0)) + delta_);  // z^-1
    one_minus_back_ = -std::conj(delta_);
    whole_ = static_cast<Real>(instants_.whole_samples);
    turn_ = std::polar(Real(1.0), -whole_ * Real(angle));
    solve();
  }

  [[nodiscard]] std::complex<double> value() const { return rounded(turn_ * value_); }

  /// What rounding leaves uncertain of a motion that is slow against the fastest.
  [[nodiscard]] double lost_digits() const {
    const Real ratio = generator_.m.topLeftCorner(n_, n_).cwiseAbs().rowwise().sum().maxCoeff() *
                       Real(instants_.with_new + instants_.with_old) / std::abs(delta_);
    return static_cast<double>(std::numeric_limits<Real>::epsilon() * ratio * ratio);
  }

  [[nodiscard]] std::complex<double> by_angle() const {
    const Complex j(Real(0.0), Real(1.0));
    // d delta = j z, d z^-1 = -j z^-1
    const Complex slope = -j * std::conj(back_) * dot(y_, x_) - j * back_ * dot(y_, all_ - first_);
    return rounded(turn_ * (slope - j * whole_ * value_));
  }

  [[nodiscard]] std::vector<std::complex<double>> by_parameter(std::span<const DesignParameter> parameters) {
    take_gradient();
    std::vector<std::complex<double>> derivatives;
    derivatives.reserve(parameters.size());
    for (const DesignParameter& each : parameters) derivatives.push_back(rounded(turn_ * by(each)));
    return derivatives;
  }

 private:
  static std::complex<double> rounded(const Complex& value) {
    return {static_cast<double>(value.real()), static_cast<double>(value.imag())};
  }

  template <typename A, typename B>
  static Complex dot(const A& a, const B& b) {  // without conjugation
    Complex sum(Real(0.0));
    for (Index i = 0; i < a.size(); ++i) sum += a(i) * b(i);
    return sum;
  }

  void solve() {
    const auto period = static_cast<Real>(instants_.with_new + instants_.with_old);
    exponential_.emplace(generator_.m * period);
    const Matrix& whole = exponential_->minus_one();
    all_ = whole.topRightCorner(n_, 1);
    first_ = all_;
    if (instants_.with_old > 0.0) {
      new_exponential_.emplace(generator_.m * Real(instants_.with_new));
      first_ = new_exponential_->minus_one().topRightCorner(n_, 1);
    }
    ComplexMatrix matrix = (-whole.topLeftCorner(n_, n_)).template cast<Complex>();
    matrix.diagonal().array() += delta_;
    const Eigen::FullPivLU<ComplexMatrix> solver(matrix);
    ComplexVector input(n_);
    for (Index i = 0; i < n_; ++i) input(i) = first_(i) * one_minus_back_ + all_(i) * back_;
    x_ = solver.solve(input);
    const Eigen::FullPivLU<ComplexMatrix> transposed(matrix.transpose());
    y_ = transposed.solve(generator_.output.template cast<Complex>());
    value_ = dot(generator_.output, x_);
  }

  /// gradient_: dP/dM, entry by entry.
  void take_gradient() {
    const bool fractional = instants_.with_old > 0.0;
    ComplexMatrix weights = ComplexMatrix::Zero(n_ + 1, n_ + 1);
    for (Index i = 0; i < n_; ++i) {
      for (Index k = 0; k < n_; ++k) weights(i, k) = y_(i) * x_(k);
      weights(i, n_) = fractional ? y_(i) * back_ : y_(i);
    }
    gradient_ = adjoint(*exponential_, weights, Real(instants_.with_new + instants_.with_old));
    if (!fractional) return;
    weights.setZero();
    for (Index i = 0; i < n_; ++i) weights(i, n_) = y_(i) * one_minus_back_;
    gradient_ += adjoint(*new_exponential_, weights, Real(instants_.with_new));
  }

  static ComplexMatrix adjoint(const ExponentialGradient<P>& exponential, const ComplexMatrix& weights, Real time) {
    const Matrix real = exponential.adjoint(weights.real());
    const Matrix imaginary = exponential.adjoint(weights.imag());
    ComplexMatrix gradient(real.rows(), real.cols());
    gradient.real() = time * real;
    gradient.imag() = time * imaginary;
    return gradient;
  }

  /// dP/dM(i, j) in physical coordinates, M(i, j) = scaled M(i, j) scales(i) / scales(j).
  [[nodiscard]] Complex entry(Index i, Index j) const {
    return gradient_(i, j) * (generator_.scales(j) / generator_.scales(i));
  }

  /// A row of M that is proportional to 1/p: dM = -row/p.
  [[nodiscard]] Complex by_divisor(Index row, Real divisor) const {
    Complex sum(Real(0.0));
    for (Index j = 0; j <= n_; ++j) sum += gradient_(row, j) * generator_.m(row, j);
    return -sum / divisor;
  }

  [[nodiscard]] Real mass(std::size_t body) const {
    const auto own = static_cast<Real>(device_.bodies()[body].mass);
    return body == device_.loop().held ? own + Real(device_.parameters().user.mass) : own;
  }

  /// Springs act on positions (column 0 on), dampers on velocities (column `bodies` on).
  [[nodiscard]] Complex by_ground(std::size_t body, Index column) const {
    const auto bodies = static_cast<Index>(device_.bodies().size());
    const auto i = static_cast<Index>(body);
    return -entry(bodies + i, column + i) / mass(body);
  }

  [[nodiscard]] Complex by_link(const Link& link, Index column) const {
    const auto bodies = static_cast<Index>(device_.bodies().size());
    const auto i = static_cast<Index>(link.first);
    const auto k = static_cast<Index>(link.second);
    return (entry(bodies + i, column + k) - entry(bodies + i, column + i)) / mass(link.first) +
           (entry(bodies + k, column + i) - entry(bodies + k, column + k)) / mass(link.second);
  }

  [[nodiscard]] Complex by_mass(std::size_t body) const {
    return by_divisor(static_cast<Index>(device_.bodies().size() + body), mass(body));
  }

  /// e^{A t} B = B + A Gamma(t), the slope of Gamma(t).
  template <typename Input>
  [[nodiscard]] typename P::Vector slope_of(const Input& gamma) const {
    return generator_.m.topRightCorner(n_, 1) + generator_.m.topLeftCorner(n_, n_) * gamma;
  }

  /// The force arrives later: less of u[k - l], more of u[k - l - 1].
  [[nodiscard]] Complex by_delay() const { return -one_minus_back_ * dot(y_, slope_of(first_)); }

  /// At a fixed angle and delay: both exponentials run longer, the newer by 1 + l for every 1.
  [[nodiscard]] Complex by_period() const {
    ComplexVector moved = x_;
    moved += (exponential_->minus_one().topLeftCorner(n_, n_).template cast<Complex>() * x_).eval();
    const ComplexVector change = generator_.m.topLeftCorner(n_, n_).template cast<Complex>() * moved;
    return dot(y_, change) + (Real(1.0) + whole_) * one_minus_back_ * dot(y_, slope_of(first_)) +
           back_ * dot(y_, slope_of(all_));
  }

  [[nodiscard]] Complex by_lag() const {
    const double lag = device_.parameters().actuator.time_constant;
    // A short lag is a short delay.
    const Index tracked = device_.parameters().sensor.tracking_bandwidth > 0.0 ? 2 : 0;
    return lag > 0.0 ? by_divisor(n_ - 1 - tracked, Real(lag)) : by_delay();
  }

  /// Its two rows of M are proportional to it.
  [[nodiscard]] Complex by_tracking() const {
    const Real bandwidth(device_.parameters().sensor.tracking_bandwidth);
    return -by_divisor(n_ - 2, bandwidth) - by_divisor(n_ - 1, bandwidth);
  }

  [[nodiscard]] Complex by(const DesignParameter& parameter) const {
    const std::size_t held = device_.loop().held;
    const auto velocities = static_cast<Index>(device_.bodies().size());
    switch (parameter.kind) {
      case Kind::body_mass:
        return by_mass(parameter.index);
      case Kind::body_damping:
        return by_ground(parameter.index, velocities);
      case Kind::body_stiffness:
        return by_ground(parameter.index, 0);
      case Kind::link_stiffness:
        return by_link(device_.links()[parameter.index], 0);
      case Kind::link_damping:
        return by_link(device_.links()[parameter.index], velocities);
      case Kind::sampling_period:
        return by_period();
      case Kind::delay:
        return by_delay();
      case Kind::time_constant:
        return by_lag();
      case Kind::tracking_bandwidth:
        return by_tracking();
      case Kind::user_mass:
        return by_mass(held);
      case Kind::user_damping:
        return by_ground(held, velocities);
      case Kind::user_stiffness:
        return by_ground(held, 0);
      case Kind::wall_damping:
      case Kind::velocity_filter_hz:
      case Kind::filter_frequency_hz:
      case Kind::filter_damping_ratio:
      case Kind::filter_depth:
      case Kind::filter_ratio:
      case Kind::transmission:
      case Kind::mechanism_damping:
      case Kind::mechanism_stiffness:
      case Kind::mechanism_inertia:
      case Kind::joint_position:
        break;
    }
    return Complex(Real(0.0));
  }

  const Device& device_;
  Generator<P> generator_;
  SamplingInstants instants_;
  Index n_;
  Complex delta_, back_, one_minus_back_, turn_, value_;
  Real whole_;
  std::optional<ExponentialGradient<P>> exponential_;      // of the whole period
  std::optional<ExponentialGradient<P>> new_exponential_;  // of the part with the newer force, where there are two
  typename P::Vector all_, first_;                         // Gamma of the whole period; Gamma1
  ComplexVector x_, y_;
  ComplexMatrix gradient_;
};

template <typename P>
PlantSensitivity all_of(PlantDerivatives<P>& derivatives, std::span<const DesignParameter> parameters) {
  return {derivatives.value(), derivatives.by_angle(), derivatives.by_parameter(parameters)};
}

template <int Most>
PlantSensitivity derivatives_up_to(const Device& device, double angle, std::span<const DesignParameter> parameters,
                                   std::optional<std::complex<double>> reference) {
  if (reference) {
    PlantDerivatives<Precision<double, Most>> derivatives(device, angle);
    const bool is_clear = derivatives.lost_digits() <= most_lost;
    if (is_clear && std::abs(derivatives.value() - *reference) <= agreement * std::abs(*reference))
      return all_of(derivatives, parameters);
  }
  // One size for all: this is the rare way, and a second one takes a compiler 15 s.
  PlantDerivatives<Precision<long double, Eigen::Dynamic>> finer(device, angle);
  return all_of(finer, parameters);
}

}  // namespace

PlantSensitivity plant_sensitivity(const Device& device, double angle, std::span<const DesignParameter> parameters,
                                   std::optional<std::complex<double>> reference) {
  require_no_coordinates(device);
  const std::size_t tracking = device.parameters().sensor.tracking_bandwidth > 0.0 ? 2 : 0;
  const auto size = tracking + (device.has_bodies() ? 2 * device.bodies().size() + 2
                                                    : device.parameters().transfer_function->denominator.size() + 1);
  return size <= static_cast<std::size_t>(small_size)
             ? derivatives_up_to<static_cast<int>(small_size)>(device, angle, parameters, reference)
             : derivatives_up_to<Eigen::Dynamic>(device, angle, parameters, reference);
}

}  // namespace zwidth::internal
