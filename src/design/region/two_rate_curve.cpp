#include "design/region/two_rate_curve.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sampling/inner_loop.hpp"
#include "stability/loop/damper_response.hpp"

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;

constexpr double angle_step_of_slope = 1e-6;  // of the angle
constexpr int most_newton_steps = 20;
constexpr double newton_tolerance = 1e-13;  // in shares
constexpr double longest_newton_step = 0.5;

Sampling fast_sampling(double period, std::size_t steps, double delay) {
  return {period / static_cast<double>(steps), delay};
}

// 1 - e^{-j angle}
Complex one_minus_back(double angle) {
  const double half = 0.5 * angle;
  return 2.0 * std::sin(half) * Complex(std::sin(half), std::cos(half));
}

// P(e^{j angle}), 0 < angle < 2 pi.
Complex on_whole_circle(const SampledPlant& plant, double angle) {
  if (angle <= std::numbers::pi) return response(plant, angle / plant.period);
  return std::conj(response(plant, (2.0 * std::numbers::pi - angle) / plant.period));
}

}  // namespace

TwoRateCurve::TwoRateCurve(const Device& device) : loop_(device, 1.0), modes_(loop_.spring_alone()) {
  const Sampling& spring = loop_.spring();
  const Sampling& damper = loop_.damper().sampling;
  const bool damper_inside = is_damper_inside();
  const Sampling& slow = damper_inside ? spring : damper;
  const Sampling& fast = damper_inside ? damper : spring;
  steps_ = steps_within(slow, fast);
  outer_period_ = slow.period;
  inner_period_ = slow.period / static_cast<double>(steps_);
  outer_ = sample(loop_.form(), fast_sampling(slow.period, steps_, slow.delay));
  inner_ = sample(loop_.form(), fast_sampling(slow.period, steps_, fast.delay));
  same_delay_ = slow.delay == fast.delay;
}

GainCrossings TwoRateCurve::crossings(double inside) const {
  if (!is_damper_inside()) return damping_crossings(loop_.seen_by_damper(inside), loop_.gains());
  InnerLoop damper = loop_.damper();
  damper.damping = inside;
  return stiffness_crossings(filtered_plant(sample_behind(loop_.form(), loop_.spring(), damper), {}), VirtualDamper{});
}

GainCrossings TwoRateCurve::crossings_alone() const {
  if (!is_damper_inside()) return stiffness_crossings(filtered_plant(modes_, {}), VirtualDamper{});
  return damping_crossings(filtered_plant(sample(loop_.form(), loop_.damper().sampling), {}), loop_.gains());
}

TwoRateCurve::Alias TwoRateCurve::alias(double angle, std::size_t k, double inside) const {
  const double of_step = (angle + 2.0 * std::numbers::pi * static_cast<double>(k)) / static_cast<double>(steps_);
  const Complex outer = on_whole_circle(outer_, of_step);
  Complex controlled = same_delay_ ? outer : on_whole_circle(inner_, of_step);
  if (is_damper_inside()) controlled *= damper_response(loop_.gains(), inner_period_, of_step / inner_period_);
  const Complex closed = 1.0 + inside * controlled;
  return {one_minus_back(angle) / one_minus_back(of_step) * outer / closed, -controlled / closed};
}

TwoRateCurve::Seen TwoRateCurve::seen(double angle, double inside) const {
  Complex sum = 0.0;
  Complex slope = 0.0;
  for (std::size_t k = 0; k < steps_; ++k) {
    const Alias each = alias(angle, k, inside);
    sum += each.moved;
    slope += each.moved * each.by_inside;
  }
  Complex gain = static_cast<double>(steps_) / sum;
  if (!is_damper_inside()) gain /= damper_response(loop_.gains(), outer_period_, angle / outer_period_);
  return {gain, -gain * slope / sum};
}

double TwoRateCurve::usual_inside(double angle) const {
  double loop_gain = std::abs(on_whole_circle(inner_, angle));
  if (is_damper_inside()) loop_gain *= std::abs(damper_response(loop_.gains(), inner_period_, angle / inner_period_));
  return 1.0 / loop_gain;
}

double TwoRateCurve::seen_angle(double angle) const {
  return std::abs(std::remainder(static_cast<double>(steps_) * angle, 2.0 * std::numbers::pi));
}

std::optional<double> TwoRateCurve::drift_stiffness() const {
  double at_rest = 0.0;
  for (const SampledTerm& term : modes_.terms) {
    if (term.integrators > 0) return std::nullopt;
    at_rest += term.numerator[0] / term.denominator[0];
  }
  return at_rest < 0.0 ? std::optional(-1.0 / at_rest) : std::nullopt;
}

std::optional<double> TwoRateCurve::unreached_gain() const {
  if (steps_ % 2 != 0) return std::nullopt;
  Complex controlled = on_whole_circle(inner_, std::numbers::pi);
  if (is_damper_inside()) controlled *= damper_response(loop_.gains(), inner_period_, std::numbers::pi / inner_period_);
  const double gain = -1.0 / controlled.real();
  return gain > 0.0 && std::isfinite(gain) ? std::optional(gain) : std::nullopt;
}

TwoRateCurve::Equations TwoRateCurve::equations(const Node& node) const {
  const double q = inside(node.wall);
  const Seen here = seen(node.angle, q);
  const double step = angle_step_of_slope * node.angle;
  const Complex by_angle =
      (seen(node.angle + step, q).gain - seen(node.angle - step, q).gain) * (scales(0) / (2.0 * step));
  const double scale_outside = is_damper_inside() ? scales(1) : scales(2);
  const double scale_inside = is_damper_inside() ? scales(2) : scales(1);
  const Complex value = (outside(node.wall) + here.gain) / scale_outside;
  const Complex slope_angle = by_angle / scale_outside;
  const Complex slope_inside = here.by_inside * (scale_inside / scale_outside);
  Equations result;
  result.value << value.real(), value.imag();
  const Eigen::Index of_outside = is_damper_inside() ? 1 : 2;
  const Eigen::Index of_inside = is_damper_inside() ? 2 : 1;
  result.slopes.col(0) << slope_angle.real(), slope_angle.imag();
  result.slopes.col(of_outside) << 1.0, 0.0;
  result.slopes.col(of_inside) << slope_inside.real(), slope_inside.imag();
  return result;
}

Eigen::Vector3d TwoRateCurve::tangent(const Node& node) const {
  const Equations at = equations(node);
  const Eigen::Vector3d first = at.slopes.row(0).transpose().normalized();
  const Eigen::Vector3d second = at.slopes.row(1).transpose().normalized();
  return Eigen::Vector3d(first(1) * second(2) - first(2) * second(1), first(2) * second(0) - first(0) * second(2),
                         first(0) * second(1) - first(1) * second(0))
      .normalized();
}

std::optional<TwoRateCurve::Node> TwoRateCurve::solve(const Node& guess, const Eigen::Vector3d& normal) const {
  Node node = guess;
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  double last = longest_newton_step;
  for (int i = 0; i < most_newton_steps; ++i) {
    const Equations at = equations(node);
    Eigen::Matrix3d matrix;
    Eigen::Vector3d right;
    for (Eigen::Index row = 0; row < 2; ++row) {
      const double size = at.slopes.row(row).norm();
      matrix.row(row) = at.slopes.row(row) / size;
      right(row) = -at.value(row) / size;
    }
    matrix.row(2) = normal.transpose();
    right(2) = -normal.dot(moved);
    const Eigen::Vector3d step = matrix.inverse() * right;
    const double length = step.norm();
    if (!(length <= longest_newton_step)) return std::nullopt;
    moved += step;
    node.angle += step(0) * scales(0);
    node.wall.stiffness += step(1) * scales(1);
    node.wall.damping += step(2) * scales(2);
    if (!(node.angle > 0.0 && node.angle < 2.0 * std::numbers::pi)) return std::nullopt;
    // Rounding of the equations may keep it from the tolerance.
    if (length <= newton_tolerance || (length < 1e-9 && length >= 0.5 * last)) return node;
    last = length;
  }
  return std::nullopt;
}

double TwoRateCurve::frequency(const Node& node) const {
  if (is_damper_inside() || node.angle > std::numbers::pi) return node.angle / outer_period_;
  double most = -1.0;
  double best = node.angle;
  for (std::size_t k = 0; k < steps_; ++k) {
    const double size = std::abs(alias(node.angle, k, inside(node.wall)).moved);
    if (!(size > most)) continue;
    most = size;
    best = (node.angle + 2.0 * std::numbers::pi * static_cast<double>(k)) / static_cast<double>(steps_);
  }
  return std::min(best, 2.0 * std::numbers::pi - best) / inner_period_;
}

}  // namespace zwidth::internal
