#pragma once

// Partial fractions of G(s) from its poles, in double-double. Private to modal_form().
//
// Around a group I of poles G = f / p_I with p_I = prod (s - pole) and f analytic; the group's term is
// (f mod p_I) / p_I. f is evaluated as G p_I on circles around the poles, d being the distance of the next other pole.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "model/extended_precision.hpp"
#include "model/pole_groups.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth::internal::partial_fractions {

using ComplexX = Complex<Extended>;
using PolynomialX = std::vector<ComplexX>;  // ascending powers

// h of the value of f at a pole: averaged over four points around it, the error is (h/d)^4.
inline constexpr double value_offset = 1e-5;
// Two poles closer than this, relative to d, take f mod p_I from the Taylor series of f about their middle, by the
// trapezoidal rule on a circle of radius taylor_radius d; the error is taylor_radius^taylor_points.
inline constexpr double taylor_below = 1e-3;
inline constexpr double taylor_radius = 0.02;
inline constexpr std::size_t taylor_points = 16;
inline constexpr std::size_t taylor_terms = 8;
// Points on the circle of a contour integral; the error falls like (ratio of radii)^points.
inline constexpr std::size_t contour_points = 96;
// A numerator that vanishes at its poles to this, relative, has a factor in common with the denominator.
inline constexpr double cancel_below = 1e-20;
// A mode whose numerator is smaller than this, relative to the largest, is rounding: the path does not see the mode.
inline constexpr double unseen_below = 1e-20;

PolynomialX expand_product(const std::vector<ComplexX>& roots);
PolynomialX multiply(const PolynomialX& a, const PolynomialX& b);
PolynomialX shifted(const PolynomialX& p, const ComplexX& center);  // from powers of (s - center) to powers of s
ComplexX product(const std::vector<ComplexX>& roots, const ComplexX& s);
// Monic polynomial from the power sums sigma_1..sigma_k of its roots (Newton's identities).
PolynomialX from_power_sums(const std::vector<ComplexX>& sums);
// exp(2 pi i (k + 1/2) / count), k = 0 .. count - 1, in double-double.
std::vector<ComplexX> directions(std::size_t count);
template <std::size_t Count>
const std::vector<ComplexX>& circle_directions() {
  static const std::vector<ComplexX> computed = directions(Count);
  return computed;
}
// Distance from the group to the nearest other pole; the size of its own poles where there is none.
double isolation(const PoleGroup& group, const std::vector<ComplexX>& all_poles);
// Divides out factors s that numerator and denominator have in common, to rounding: repeated modes of a symmetric
// device, and motions at rest that the path does not see. `scale`: the frequency at which coefficients compare.
void cancel_common_factors(PolynomialX& numerator, PolynomialX& denominator, double scale);
// The real term of numerator / denominator, plus its conjugate unless the group is closed.
ModalTerm real_term(const PoleGroup& group, PolynomialX numerator, PolynomialX denominator);
// Clears numerators of modes that the path does not see.
void clear_unseen(ModalForm& form);
// Says how much of the terms of lag and tracking stems from each mode.
void share_drive(ModalForm& form, const DrivePath& drive);

template <typename Pencil>
ComplexX analytic_part(const Pencil& pencil, const PoleGroup& group, const ComplexX& s) {
  return pencil.gain(s) * product(group.poles, s);
}

template <typename Pencil>
ComplexX analytic_value(const Pencil& pencil, const PoleGroup& group, const ComplexX& s, double nearest) {
  const Extended h(value_offset * nearest);
  const ComplexX real{h};
  const ComplexX imaginary{Extended(0.0), h};
  return (analytic_part(pencil, group, s + real) + analytic_part(pencil, group, s - real) +
          analytic_part(pencil, group, s + imaginary) + analytic_part(pencil, group, s - imaginary)) *
         Extended(0.25);
}

// Two real poles, or a pair of conjugates: N = f(first) + f[first, second] (s - first); close together, with
// q = (half their gap)², < 0 of conjugates, and Taylor coefficients f_j about their middle c,
// N = sum f_2k q^k + (s - c) sum f_2k+1 q^k.
template <typename Pencil>
PolynomialX pair_numerator(const Pencil& pencil, const PoleGroup& group, double nearest) {
  const ComplexX& first = group.poles[0];
  const ComplexX& second = group.poles[1];
  if (magnitude(first - second) > taylor_below * nearest) {
    const ComplexX value = analytic_value(pencil, group, first, nearest);
    const ComplexX slope = (value - analytic_value(pencil, group, second, nearest)) / (first - second);
    return {value - slope * first, slope};
  }
  const ComplexX middle = (first + second) * Extended(0.5);
  const Extended radius(taylor_radius * nearest);
  std::vector<Extended> coefficients(taylor_terms, Extended(0.0));  // f_j radius^j: real, as f and the middle are
  const std::vector<ComplexX>& directions = circle_directions<taylor_points>();
  for (std::size_t i = 0; i < taylor_points / 2; ++i) {  // the conjugate half adds the conjugate
    const ComplexX value = analytic_part(pencil, group, middle + directions[i] * radius);
    ComplexX turn = value;
    for (std::size_t j = 0; j < taylor_terms; ++j) {
      coefficients[j] += turn.re * Extended(2.0 / static_cast<double>(taylor_points));
      turn *= conj(directions[i]);
    }
  }
  const Extended half_gap = (first.re - second.re) * Extended(0.5) / radius;
  const Extended half_height = (first.im - second.im) * Extended(0.5) / radius;  // of a pair of conjugates
  const Extended q = half_gap * half_gap - half_height * half_height;
  Extended value(0.0);
  Extended slope(0.0);
  for (std::size_t j = taylor_terms; j >= 2; j -= 2) {
    value = value * q + coefficients[j - 2];
    slope = slope * q + coefficients[j - 1];
  }
  slope = slope / radius;
  return {ComplexX(value) - middle * slope, ComplexX(slope)};
}

// A cluster: p_I from sigma_j = 1/(2 pi i) contour integral of s^j p'/p ds, N = polynomial part of
// p_I(s) sum_j mu_j s^-(j+1) with mu_j = 1/(2 pi i) contour integral of s^j G ds, in coordinates of the cluster's
// centre.
template <typename Pencil>
ModalTerm cluster_term(const Pencil& pencil, const PoleGroup& group, const std::vector<ComplexX>& all_poles) {
  const std::size_t k = group.poles.size();
  const double nearest = isolation(group, all_poles);
  ComplexX center;
  for (const ComplexX& pole : group.poles) center += pole;
  center = center * (Extended(1.0) / Extended(static_cast<double>(k)));
  if (group.closed) center.im = Extended(0.0);
  double spread = 0.1 * nearest;
  for (const ComplexX& pole : group.poles) spread = std::max(spread, magnitude(pole - center));
  const bool is_all = k == all_poles.size() && spread > 0.1 * nearest;  // no other pole is near a wider circle
  const Extended radius = Extended(is_all ? 4.0 * spread : std::sqrt(spread * nearest));

  std::vector<ComplexX> points = circle_directions<contour_points>();
  std::vector<ComplexX> log_derivative(contour_points);
  std::vector<ComplexX> gain(contour_points);
  const std::vector<DrivePole> of_drive = poles_of(pencil.drive);
  const ComplexX one{Extended(1.0)};
  for (std::size_t i = 0; i < contour_points; ++i) {
    points[i] = points[i] * radius;
    const ComplexX s = center + points[i];
    gain[i] = pencil.gain(s);
    log_derivative[i] = one / pencil.newton_step(s);
    for (std::size_t zero = 0; zero < pencil.zero_roots; ++zero) log_derivative[i] += one / s;
    for (const DrivePole& pole : of_drive) {
      log_derivative[i] += ComplexX(Extended(static_cast<double>(pole.copies))) / (s - pole.at);
    }
  }
  const auto moment = [&points](const std::vector<ComplexX>& values, std::size_t order) {
    ComplexX sum;
    for (std::size_t i = 0; i < contour_points; ++i) {
      ComplexX term = values[i] * points[i];  // ds = i s dphi
      for (std::size_t j = 0; j < order; ++j) term *= points[i];
      sum += term;
    }
    return sum * (Extended(1.0) / Extended(static_cast<double>(contour_points)));
  };
  if (std::abs(leading(moment(log_derivative, 0).re) - static_cast<double>(k)) > 1e-6) {
    throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::poles_not_told_apart});
  }
  std::vector<ComplexX> sums;
  for (std::size_t j = 1; j <= k; ++j) sums.push_back(moment(log_derivative, j));
  PolynomialX denominator = from_power_sums(sums);
  if (magnitude(center) == 0.0) denominator = expand_product(group.poles);  // all at zero, exactly
  const auto at_zero = std::ranges::count_if(group.poles, [](const ComplexX& pole) { return magnitude(pole) == 0.0; });
  PolynomialX numerator(k);
  for (std::size_t j = 0; j < k; ++j) {
    const ComplexX mu = moment(gain, j);
    for (std::size_t power = 0; power + j + 1 <= k; ++power) numerator[power] += denominator[power + j + 1] * mu;
  }
  cancel_common_factors(numerator, denominator, leading(radius));
  denominator = shifted(denominator, center);
  std::fill_n(denominator.begin(), std::min(at_zero, std::ssize(denominator) - 1), ComplexX());
  return real_term(group, shifted(numerator, center), std::move(denominator));
}

template <typename Pencil>
ModalTerm term_of(const Pencil& pencil, const PoleGroup& group, const std::vector<ComplexX>& all_poles) {
  if (group.cluster) return cluster_term(pencil, group, all_poles);
  const double nearest = isolation(group, all_poles);
  PolynomialX denominator = expand_product(group.poles);
  PolynomialX numerator = group.poles.size() == 1 ? PolynomialX{analytic_value(pencil, group, group.poles[0], nearest)}
                                                  : pair_numerator(pencil, group, nearest);
  if (magnitude(denominator[0]) == 0.0) cancel_common_factors(numerator, denominator, nearest);
  return real_term(group, std::move(numerator), std::move(denominator));
}

// Sum of terms from all non-zero poles (closed under conjugation to rounding); poles at zero and of the drive are added.
template <typename Pencil>
ModalForm expand(const Pencil& pencil, std::vector<ComplexX> poles, const PoleLabels& labels) {
  ModalForm form;
  std::vector<PoleGroup> groups = group_poles(poles, pencil.zero_roots, labels, form);
  for (const DrivePole& pole : poles_of(pencil.drive)) {
    poles.insert(poles.end(), pole.copies, pole.at);
    add_drive_pole(groups, pole);
  }
  for (const PoleGroup& group : groups) form.terms.push_back(term_of(pencil, group, poles));
  clear_unseen(form);
  share_drive(form, pencil.drive);
  return form;
}

}  // namespace zwidth::internal::partial_fractions
