#include "design/region/two_rate_curve.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sampling/inner_loop.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;

// At a pole of the loop inside P is beyond all numbers; its inverse, 0, is not.
constexpr double at_pole = 1e-100;
constexpr int most_newton_steps = 20;
constexpr double newton_tolerance = 1e-13;  // in shares
constexpr double longest_newton_step = 0.5;

Sampling fast_sampling(double period, std::size_t steps, double delay) {
  return {period / static_cast<double>(steps), delay};
}

}  // namespace

TwoRateCurve::TwoRateCurve(const Device& device)
    : loop_(device, 1.0),
      behind_(loop_.form(), loop_.is_damper_inside() ? loop_.spring() : loop_.damper().sampling,
              loop_.is_damper_inside() ? loop_.damper().sampling : loop_.spring()),
      modes_(loop_.spring_alone()) {
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
  inner_filter_ = velocity_filter_pole(velocity_filter_hz(), inner_period_);
  outer_filter_ = velocity_filter_pole(velocity_filter_hz(), outer_period_);
  for (std::size_t k = 0; k < steps_; ++k) {
    turns_.emplace_back(std::numbers::pi * static_cast<double>(k) / static_cast<double>(steps_));
  }
}

GainCrossings TwoRateCurve::crossings(double inside) const {
  InnerLoop inner;
  if (is_damper_inside()) {
    inner = loop_.damper();
    inner.damping = inside;
  } else {
    inner.stiffness = inside;
  }
  const FilteredPlant plant = filtered_plant(behind_.closed_by(inner), {});
  return is_damper_inside() ? stiffness_crossings(plant, VirtualDamper{}) : damping_crossings(plant, loop_.gains());
}

GainCrossings TwoRateCurve::crossings_alone() const {
  if (!is_damper_inside()) return stiffness_crossings(filtered_plant(modes_, {}), VirtualDamper{});
  return damping_crossings(filtered_plant(sample(loop_.form(), loop_.damper().sampling), {}), loop_.gains());
}

TwoRateCurve::Alias TwoRateCurve::alias(const HalfTurn& longer, const HalfTurn& shorter, double inside) const {
  const Complex j(0.0, 1.0);
  const double by_step = 1.0 / static_cast<double>(steps_);  // of the slopes over the angle of a sample
  const ResponseAndSlope outer = response_and_slope(outer_, shorter);
  ResponseAndSlope controlled = same_delay_ ? outer : response_and_slope(inner_, shorter);
  if (is_damper_inside()) {
    const ResponseAndSlope velocity = velocity_and_slope(inner_filter_, inner_period_, shorter);
    controlled.slope = controlled.slope * velocity.value + controlled.value * velocity.slope;
    controlled.value *= velocity.value;
  }
  const Complex hold = quotient(longer.one_minus_back(), shorter.one_minus_back());
  const Complex hold_slope =
      quotient(j * longer.back() - hold * (j * by_step) * shorter.back(), shorter.one_minus_back());
  Complex closed = 1.0 + inside * controlled.value;
  if (closed == 0.0) closed = at_pole;
  const Complex share = quotient(1.0, closed);
  Alias result;
  result.moved = hold * outer.value * share;
  result.by_inside = -result.moved * controlled.value * share;
  result.by_angle = (hold_slope * outer.value + by_step * hold * outer.slope) * share -
                    result.moved * (inside * by_step) * controlled.slope * share;
  return result;
}

HalfTurn TwoRateCurve::alias_of(const HalfTurn& first, std::size_t k) const { return first.turned_by(turns_[k]); }

TwoRateCurve::Seen TwoRateCurve::seen(double angle, double inside) const {
  const HalfTurn longer(0.5 * angle);
  const HalfTurn first(0.5 * angle / static_cast<double>(steps_));
  Alias sum;
  for (std::size_t k = 0; k < steps_; ++k) {
    const Alias each = alias(longer, alias_of(first, k), inside);
    sum.moved += each.moved;
    sum.by_inside += each.by_inside;
    sum.by_angle += each.by_angle;
  }
  Seen result;
  result.gain = quotient(static_cast<double>(steps_), sum.moved);
  const Complex per_sum = quotient(result.gain, sum.moved);
  result.by_inside = -per_sum * sum.by_inside;
  result.by_angle = -per_sum * sum.by_angle;
  if (is_damper_inside()) return result;
  const ResponseAndSlope velocity = velocity_and_slope(outer_filter_, outer_period_, longer);
  result.gain = quotient(result.gain, velocity.value);
  result.by_inside = quotient(result.by_inside, velocity.value);
  result.by_angle = quotient(result.by_angle - result.gain * velocity.slope, velocity.value);
  return result;
}

double TwoRateCurve::usual_inside(double angle) const {
  const HalfTurn turn(0.5 * angle);
  double loop_gain = std::abs(response_and_slope(inner_, turn).value);
  if (is_damper_inside()) loop_gain *= std::abs(velocity_and_slope(inner_filter_, inner_period_, turn).value);
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
  const HalfTurn turn(0.5 * std::numbers::pi);
  Complex controlled = response_and_slope(inner_, turn).value;
  if (is_damper_inside()) controlled *= velocity_and_slope(inner_filter_, inner_period_, turn).value;
  const double gain = -1.0 / controlled.real();
  return gain > 0.0 && std::isfinite(gain) ? std::optional(gain) : std::nullopt;
}

TwoRateCurve::Equations TwoRateCurve::equations(const Node& node) const {
  const double q = inside(node.wall);
  const Seen here = seen(node.angle, q);
  const double scale_outside = is_damper_inside() ? scales(1) : scales(2);
  const double scale_inside = is_damper_inside() ? scales(2) : scales(1);
  const Complex value = (outside(node.wall) + here.gain) / scale_outside;
  const Complex slope_angle = here.by_angle * (scales(0) / scale_outside);
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
  const HalfTurn longer(0.5 * node.angle);
  const HalfTurn first(0.5 * node.angle / static_cast<double>(steps_));
  for (std::size_t k = 0; k < steps_; ++k) {
    const double size = std::abs(alias(longer, alias_of(first, k), inside(node.wall)).moved);
    if (!(size > most)) continue;
    most = size;
    best = (node.angle + 2.0 * std::numbers::pi * static_cast<double>(k)) / static_cast<double>(steps_);
  }
  return std::min(best, 2.0 * std::numbers::pi - best) / inner_period_;
}

}  // namespace zwidth::internal
