#include "stability/pole_count.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "model/balance.hpp"
#include "stability/winding_number.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/filter_section.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth::internal {
namespace {

// A pole this close to the circle, over |z - 1|, may be on either side: its eigenvalue is rounded.
constexpr double rounding = 1e-12;
// The same for a pole at z = 1 itself, such as the place of a body that dampers alone tie to the rest.
constexpr double rounding_at_one = 1e-13;

// Eigenvalues cost the cube of the states, the winding number their product with the angles.
constexpr std::size_t most_states_for_eigenvalues = 40;
constexpr std::size_t steps_per_state = 8;

// Just outside the circle, so that a mode that nothing damps and nothing moves lies inside.
constexpr double radius = 1.0 + 1e-13;

// det(delta I - Phi + (Gamma1 + Gamma2 / z) z^-l C(z) c) at z = radius e^{j angle}: zero where a closed-loop pole is.
class ReturnDifference {
  using Complex = std::complex<double>;

 public:
  ReturnDifference(const DiscreteStateSpace& plant, const Wall& wall, double stiffness)
      : delay_samples_(static_cast<double>(plant.delay_samples)), stiffness_(stiffness) {
    const Eigen::VectorXd scales = balancing_scales(plant.Phi);
    const Eigen::MatrixXd phi = scales.cwiseInverse().asDiagonal() * plant.Phi * scales.asDiagonal();
    phi_ = phi.cast<Complex>();
    gamma1_ = scales.cwiseInverse().asDiagonal() * plant.Gamma1;
    gamma2_ = scales.cwiseInverse().asDiagonal() * plant.Gamma2;
    output_ = plant.C * scales.asDiagonal();
    pole_ = velocity_filter_pole(wall.velocity_filter_hz, plant.period);
    rate_ = wall.damping * (1.0 - pole_) / plant.period;
    for (const WallFilter& filter : wall.filters) filters_.push_back(filter_section(filter, plant.period));
  }

  [[nodiscard]] Complex operator()(double angle) {
    const double half = std::sin(0.5 * angle);
    const Complex circle(-2.0 * half * half, std::sin(angle));  // e^{j angle} - 1
    const Complex delta = circle + (radius - 1.0) * (1.0 + circle);
    const Complex z = 1.0 + delta;
    Complex wall = stiffness_ + rate_ * delta / (z - pole_);
    for (const FilterSection& filter : filters_) wall *= response_of(filter, delta);
    wall *= std::polar(std::exp(-delay_samples_ * std::log(radius)), -delay_samples_ * angle);
    matrix_ = -phi_;
    matrix_.diagonal().array() += delta;
    matrix_.noalias() += (wall * gamma1_ + (wall / z) * gamma2_) * output_;
    return factors_.compute(matrix_).determinant();
  }

 private:
  static Complex response_of(const FilterSection& filter, Complex delta) {
    const std::array<double, 3> numerator = whole_numerator(filter);
    Complex n = 0.0;
    Complex d = 1.0;
    for (std::size_t i = filter.degree + 1; i-- > 0;) n = n * delta + numerator[i];
    for (std::size_t i = filter.degree; i-- > 0;) d = d * delta + filter.denominator[i];
    return n / d;
  }

  Eigen::MatrixXcd phi_;
  Eigen::VectorXcd gamma1_;
  Eigen::VectorXcd gamma2_;
  Eigen::RowVectorXcd output_;
  Eigen::MatrixXcd matrix_;  // of one angle, and its factors: no allocation for each
  Eigen::PartialPivLU<Eigen::MatrixXcd> factors_;
  std::vector<FilterSection> filters_;
  double delay_samples_;
  double stiffness_;
  double pole_ = 0.0;  // of the velocity's low-pass
  double rate_ = 0.0;  // B (1 - a) / T
};

}  // namespace

PoleCount::PoleCount(const Device& device)
    : device_(device), plant_(sample(state_space(device), {device.loop().sampling_period, device.loop().delay})) {
  const Wall& wall = device.parameters().wall;
  states_ = static_cast<std::size_t>(plant_.Phi.rows()) + plant_.delay_samples + (plant_.Gamma2.isZero(0.0) ? 0 : 1) +
            (wall.damping > 0.0 ? 1 : 0);
  for (const WallFilter& filter : wall.filters) states_ += filter_section(filter, plant_.period).degree;
  if (states_ <= most_states_for_eigenvalues && RouthCount::suits(plant_)) routh_.emplace(plant_, wall);
}

bool PoleCount::confirms(double stiffness, bool stable) const {
  if (routh_ && routh_->surely(stable, stiffness, device_.parameters().wall.damping)) return true;
  const std::optional<int> outside = in_double(stiffness);
  return outside && (*outside == 0) == stable;
}

std::optional<int> PoleCount::in_double(double stiffness) const {
  if (!plant_.Phi.allFinite() || !plant_.Gamma1.allFinite() || !plant_.Gamma2.allFinite()) return std::nullopt;
  return states_ <= most_states_for_eigenvalues ? by_eigenvalues(stiffness) : by_winding(stiffness);
}

std::optional<int> PoleCount::in_digits(double stiffness) const {
  return states_ <= most_states_for_digits ? unstable_poles_in_digits(device_, stiffness) : std::nullopt;
}

void PoleCount::polish_in_digits(std::vector<PoleOnCircle>& poles) const {
  if (states_ <= most_states_for_digits && !poles.empty()) polish_poles_in_digits(device_, poles);
}

std::optional<int> PoleCount::by_eigenvalues(double stiffness) const {
  Wall wall = device_.parameters().wall;
  wall.stiffness = stiffness;
  int outside = 0;
  for (const std::complex<double>& delta : closed_loop_poles_minus_one(plant_, wall)) {
    // |1 + d| - 1 = (2 Re d + |d|²) / (|1 + d| + 1)
    const double excess = (2.0 * delta.real() + std::norm(delta)) / (std::abs(1.0 + delta) + 1.0);
    if (!(std::abs(excess) > std::max(rounding * std::abs(delta), rounding_at_one))) return std::nullopt;
    if (excess > 0.0) ++outside;
  }
  return outside;
}

std::optional<int> PoleCount::by_winding(double stiffness) const {
  ReturnDifference f(plant_, device_.parameters().wall, stiffness);
  const std::optional<double> turns = winding_number(f, steps_per_state * states_);
  if (!turns) return std::nullopt;
  // All poles of f lie inside: the delays, the velocity's low-pass, the filters; f ~ delta^n far outside.
  const double outside = static_cast<double>(plant_.Phi.rows()) - *turns;
  constexpr double whole = 0.1;  // turns are whole but for rounding
  if (!(std::abs(outside - std::round(outside)) < whole)) return std::nullopt;
  return static_cast<int>(std::lround(outside));
}

}  // namespace zwidth::internal
