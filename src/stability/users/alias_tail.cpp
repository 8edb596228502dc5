#include "stability/users/alias_tail.hpp"

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "eigenvalues.hpp"

namespace zwidth::internal {
namespace {

constexpr int tail_nodes = 16;

struct LaguerreRule {
  std::array<double, tail_nodes> node{};
  std::array<double, tail_nodes> weight{};
};

/// Nodes and weights of int_0^inf e^-u f(u) du from the recurrence's tridiagonal matrix (Golub & Welsch 1969).
LaguerreRule make_rule() {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(tail_nodes, tail_nodes);
  for (int i = 0; i < tail_nodes; ++i) {
    matrix(i, i) = 2.0 * i + 1.0;
    if (i > 0) matrix(i, i - 1) = matrix(i - 1, i) = i;
  }
  const SymmetricEigen eigen = symmetric_eigen(matrix);
  LaguerreRule rule;
  for (int i = 0; i < tail_nodes; ++i) {
    rule.node[static_cast<std::size_t>(i)] = eigen.values[i];
    rule.weight[static_cast<std::size_t>(i)] = eigen.vectors(0, i) * eigen.vectors(0, i);
  }
  return rule;
}

}  // namespace

std::complex<double> alias_tail(double first, double x, double angle, int power) {
  static const LaguerreRule rule = make_rule();
  const double start = first + x;
  const std::complex<double> turn = std::polar(1.0, -angle);
  const bool still = turn.real() == 1.0;
  std::complex<double> integral = 0.0;
  for (std::size_t i = 0; i < tail_nodes; ++i) {
    const double t = rule.node[i] / start;
    const std::complex<double> sum = still ? -std::expm1(-t) : 1.0 - turn * std::exp(-t);
    integral += rule.weight[i] * std::pow(rule.node[i], power - 1) / sum;
  }
  return std::polar(1.0, -angle * first) * std::pow(start, -power) / std::tgamma(power) * integral;
}

}  // namespace zwidth::internal
