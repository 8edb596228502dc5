#include "stability/users/alias_sum_quadrature.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <boost/math/special_functions/digamma.hpp>
#include <cmath>
#include <numbers>

#include "stability/users/alias_tail.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;
constexpr int node_count = 7;             // per block
constexpr std::size_t most_blocks = 24;   // of doubling length
constexpr double steady_turns = 7.0;      // start |angle| where alias_tail() is accurate
constexpr double most_direct = 20000.0;   // terms before it, where the angle is small
constexpr std::size_t most_summed = 256;  // terms of a block that are summed one by one, without an angle

using Moments = Eigen::Matrix<std::complex<double>, node_count, 1>;

/// sum over k >= first of e^{-j angle k} (first/k)^{power + n}, n = 0..node_count - 1. Power 1 without an angle: the
/// limit from positive angles, its infinite real part of n = 0 left out.
Moments moments_to_infinity(double first, double angle, int power) {
  Moments moments = Moments::Zero();
  double start = first;
  if (angle != 0.0) start = std::max(first, std::min(std::ceil(steady_turns / std::abs(angle)), first + most_direct));
  for (double k = first; k < start; k += 1.0) {
    const double v = first / k;
    std::complex<double> term = std::polar(power == 1 ? v : v * v, -angle * k);
    for (int n = 0; n < node_count; ++n, term *= v) moments[n] += term;
  }
  for (int n = 0; n < node_count; ++n) {
    if (power + n == 1 && angle == 0.0) {
      moments[n] += std::complex<double>(0.0, -0.5 * pi * first);
    } else {
      moments[n] += std::pow(first, power + n) * alias_tail(start, 0.0, angle, power + n);
    }
  }
  return moments;
}

/// The same over first <= k < 2 first.
Moments moments_of_block(double first, double angle, int power) {
  const bool many = first > (angle == 0.0 ? static_cast<double>(most_summed) : most_direct);
  if (many) {
    Moments rest = moments_to_infinity(2.0 * first, angle, power);
    for (int n = 0; n < node_count; ++n) rest[n] *= std::pow(0.5, power + n);
    Moments moments = moments_to_infinity(first, angle, power) - rest;
    // sum of first/k
    if (power == 1 && angle == 0.0) {
      moments[0] = first * (boost::math::digamma(2.0 * first) - boost::math::digamma(first));
    }
    return moments;
  }
  Moments moments = Moments::Zero();
  for (double k = first; k < 2.0 * first; k += 1.0) {
    const double v = first / k;
    std::complex<double> term = std::polar(power == 1 ? v : v * v, -angle * k);
    for (int n = 0; n < node_count; ++n, term *= v) moments[n] += term;
  }
  return moments;
}

/// Adds the nodes v = first/k in (lower, 1] with the weights that reproduce the moments of v² v^n.
void add_block(AliasSumQuadrature& rule, double first, double lower, const Moments& turning, const Moments& still) {
  Eigen::Matrix<double, node_count, node_count> powers;  // row n: v_i^{2 + n}
  Eigen::Matrix<double, node_count, 1> nodes;
  for (int i = 0; i < node_count; ++i) {
    nodes[i] = 0.5 * (1.0 + lower) + 0.5 * (1.0 - lower) * std::cos(pi * (i + 0.5) / node_count);
    for (int n = 0; n < node_count; ++n) powers(n, i) = std::pow(nodes[i], 2 + n);
  }
  const Eigen::FullPivLU<Eigen::Matrix<double, node_count, node_count>> solver(powers);
  const Eigen::Matrix<double, node_count, 1> turning_real = solver.solve(turning.real().eval());
  const Eigen::Matrix<double, node_count, 1> turning_imaginary = solver.solve(turning.imag().eval());
  const Eigen::Matrix<double, node_count, 1> still_real = solver.solve(still.real().eval());
  for (int i = 0; i < node_count; ++i) {
    rule.nodes.push_back({first / nodes[i], {turning_real[i], turning_imaginary[i]}, still_real[i]});
  }
}

/// In -pi..pi; 0 where it is nearly so.
double within_half_turn(double angle) {
  angle = std::remainder(angle, 2.0 * pi);
  return std::abs(angle) < 1e-12 ? 0.0 : angle;
}

}  // namespace

AliasSumQuadrature alias_sum_quadrature(std::size_t exact, double steady, double angle) {
  AliasSumQuadrature rule;
  angle = within_half_turn(angle);
  for (std::size_t k = 0; k < exact; ++k) {
    const double number = static_cast<double>(k);
    rule.nodes.push_back({number, std::polar(1.0, -angle * number), 1.0});
  }
  double first = static_cast<double>(exact);
  for (std::size_t block = 0; first < steady && block < most_blocks; ++block, first *= 2.0) {
    add_block(rule, first, 0.5, moments_of_block(first, angle, 2), moments_of_block(first, 0.0, 2));
  }
  add_block(rule, first, 0.0, moments_to_infinity(first, angle, 2), moments_to_infinity(first, 0.0, 2));
  return rule;
}

AliasSumQuadrature alias_sum_quadrature_derivative(std::size_t exact, double steady, double angle) {
  AliasSumQuadrature rule;
  angle = within_half_turn(angle);
  for (std::size_t k = 0; k < exact; ++k) {
    const double number = static_cast<double>(k);
    rule.nodes.push_back({number, std::polar(number, -angle * number - 0.5 * pi), 0.0});
  }
  // -j k (first/k)^{2 + n} = -j first (first/k)^{1 + n}
  double first = static_cast<double>(exact);
  const auto turned = [&first](const Moments& moments) -> Moments {
    return std::complex<double>(0.0, -first) * moments;
  };
  for (std::size_t block = 0; first < steady && block < most_blocks; ++block, first *= 2.0) {
    add_block(rule, first, 0.5, turned(moments_of_block(first, angle, 1)), Moments::Zero());
  }
  add_block(rule, first, 0.0, turned(moments_to_infinity(first, angle, 1)), Moments::Zero());
  return rule;
}

}  // namespace zwidth::internal
