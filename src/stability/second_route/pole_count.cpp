#include "stability/second_route/pole_count.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "eigenvalues.hpp"
#include "model/balance.hpp"
#include "stability/second_route/winding_number.hpp"
#include "zwidth/model/damper_timing.hpp"
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

// f(z) = det(delta I - Phi + g(z) c), g = (Gamma1 + Gamma2 / z) z^-l C(z), at z = radius e^{j angle}: zero where a
// closed-loop pole is. With Phi = Q H Q^T, H upper Hessenberg, it is the determinant of
//     [delta I - H   Q^T g]
//     [   -c Q         1  ]
// whose columns have three entries each to eliminate with: every angle takes the square of the states. Its phase alone,
// as a number of magnitude 1; 0 where it vanishes.
class ReturnDifference {
  using Complex = std::complex<double>;

 public:
  ReturnDifference(const DiscreteStateSpace& plant, const Wall& wall, double stiffness)
      : delay_samples_(static_cast<double>(plant.delay_samples)), stiffness_(stiffness) {
    const Eigen::VectorXd scales = balancing_scales(plant.Phi);
    const Hessenberg reduced = hessenberg(scales.cwiseInverse().asDiagonal() * plant.Phi * scales.asDiagonal());
    dynamics_ = reduced.matrix;
    gamma1_ = reduced.basis.transpose() * scales.cwiseInverse().asDiagonal() * plant.Gamma1;
    gamma2_ = reduced.basis.transpose() * scales.cwiseInverse().asDiagonal() * plant.Gamma2;
    output_ = plant.C * scales.asDiagonal() * reduced.basis;
    // As large as the rows beside it, for the pivots' sake.
    const double size = output_.cwiseAbs().maxCoeff();
    if (size > 0.0 && std::isfinite(size)) {
      output_ /= size;
      gamma1_ *= size;
      gamma2_ *= size;
    }
    for (Row* row : {&upper_, &lower_, &border_}) row->resize(dynamics_.rows() + 1);
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
    return phase_of_determinant(delta, wall, wall / z);
  }

 private:
  // Real and imaginary parts apart, which a compiler makes vectors of.
  struct Row {
    Eigen::ArrayXd re;
    Eigen::ArrayXd im;

    void resize(Eigen::Index size) {
      re.resize(size);
      im.resize(size);
    }
    [[nodiscard]] Complex operator[](Eigen::Index i) const { return {re(i), im(i)}; }
    // Less factor times the other, from `begin` on.
    void subtract(Complex factor, const Row& other, Eigen::Index begin) {
      const Eigen::Index count = re.size() - begin;
      const auto other_re = other.re.tail(count);
      const auto other_im = other.im.tail(count);
      re.tail(count) -= factor.real() * other_re - factor.imag() * other_im;
      im.tail(count) -= factor.real() * other_im + factor.imag() * other_re;
    }
  };

  static double size_of(Complex value) { return std::abs(value.real()) + std::abs(value.imag()); }

  static Complex response_of(const FilterSection& filter, Complex delta) {
    const std::array<double, 3> numerator = whole_numerator(filter);
    Complex n = 0.0;
    Complex d = 1.0;
    for (std::size_t i = filter.degree + 1; i-- > 0;) n = n * delta + numerator[i];
    for (std::size_t i = filter.degree; i-- > 0;) d = d * delta + filter.denominator[i];
    return n / d;
  }

  // Row i of delta I - H, from its first entry that is not zero on, and of the border.
  void fill(Row& row, Eigen::Index i, Complex delta, Complex with_new, Complex with_old) const {
    const Eigen::Index n = dynamics_.rows();
    const Eigen::Index first = std::max<Eigen::Index>(i - 1, 0);
    row.re.segment(first, n - first) = -dynamics_.row(i).segment(first, n - first).transpose().array();
    row.im.segment(first, n - first).setZero();
    row.re(i) += delta.real();
    row.im(i) = delta.imag();
    const Complex last = with_new * gamma1_(i) + with_old * gamma2_(i);
    row.re(n) = last.real();
    row.im(n) = last.imag();
  }

  Complex phase_of_determinant(Complex delta, Complex with_new, Complex with_old) {
    const Eigen::Index n = dynamics_.rows();
    border_.re.head(n) = -output_.transpose().array();
    border_.im.setZero();
    border_.re(n) = 1.0;
    fill(upper_, 0, delta, with_new, with_old);
    Complex phase = 1.0;
    const auto take = [&phase](Complex pivot) {
      const double size = std::abs(pivot);
      phase *= size > 0.0 ? pivot / size : Complex(0.0);
    };
    for (Eigen::Index k = 0; k < n; ++k) {
      const bool is_last = k + 1 == n;
      if (!is_last) {
        fill(lower_, k + 1, delta, with_new, with_old);
        if (size_of(lower_[k]) > size_of(upper_[k])) {
          std::swap(lower_, upper_);
          phase = -phase;
        }
      }
      if (size_of(border_[k]) > size_of(upper_[k])) {
        std::swap(border_, upper_);
        phase = -phase;
      }
      const Complex pivot = upper_[k];
      take(pivot);
      if (pivot == 0.0) return 0.0;
      border_.subtract(border_[k] / pivot, upper_, k + 1);
      if (is_last) break;
      lower_.subtract(lower_[k] / pivot, upper_, k + 1);
      std::swap(lower_, upper_);
    }
    take(border_[n]);
    return phase;
  }

  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> dynamics_;  // H
  Eigen::VectorXd gamma1_;
  Eigen::VectorXd gamma2_;
  Eigen::RowVectorXd output_;
  Row upper_;  // of one angle: no allocation for each
  Row lower_;
  Row border_;
  std::vector<FilterSection> filters_;
  double delay_samples_;
  double stiffness_;
  double pole_ = 0.0;  // of the velocity's low-pass
  double rate_ = 0.0;  // B (1 - a) / T
};

}  // namespace

PoleCount::PoleCount(const Device& device)
    : device_(device), plant_(sample(state_space(device), {device.loop().sampling_period, device.loop().delay})) {
  require_one_rate(device);
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
