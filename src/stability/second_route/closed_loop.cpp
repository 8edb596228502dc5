#include "zwidth/stability/closed_loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "eigenvalues.hpp"
#include "model/balance.hpp"
#include "stability/second_route/pole_modulus.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth {
using namespace internal;

namespace {

// The loop opened where the force acts: state matrix less I, and how the force there depends on the state.
struct OpenedLoop {
  Eigen::MatrixXd loop;
  Eigen::VectorXd input;
  Eigen::RowVectorXd force;
};

OpenedLoop opened_loop(const DiscreteStateSpace& plant, const Wall& wall) {
  const DiscreteStateSpace device = with_delay_states(plant);
  const Eigen::Index n = device.Phi.rows();
  const double stiffness = wall.stiffness.value_or(0.0);
  const double rate = wall.damping / plant.period;
  // y[k-1] for the backward difference; v[k-1] for its low-pass v = a v[k-1] + (1 - a)(y - y[k-1])/T.
  const bool damped = wall.damping > 0.0;
  const bool filtered = damped && wall.velocity_filter_hz > 0.0;
  const double a = filtered ? velocity_filter_pole(wall.velocity_filter_hz, plant.period) : 0.0;
  std::vector<FilterSection> sections;
  Eigen::Index order = n + (damped ? 1 : 0) + (filtered ? 1 : 0);
  Eigen::Index next = order;
  for (const WallFilter& filter : wall.filters) {
    sections.push_back(filter_section(filter, plant.period));
    order += static_cast<Eigen::Index>(sections.back().degree);
  }
  Eigen::MatrixXd loop = Eigen::MatrixXd::Zero(order, order);  // state matrix minus I
  loop.topLeftCorner(n, n) = device.Phi;
  // u = -(K y + B v), v = a v_old + ((1 - a)/T)(y - y_old)
  Eigen::RowVectorXd force = Eigen::RowVectorXd::Zero(order);
  force.head(n) = -(stiffness + rate * (1.0 - a)) * device.C;
  if (damped) {
    force(n) = rate * (1.0 - a);
    loop.row(n).head(n) = device.C;
    loop(n, n) = -1.0;
  }
  if (filtered) {  // the filter state holds T v
    force(n + 1) = -rate * a;
    loop.row(n + 1).head(n) = (1.0 - a) * device.C;
    loop(n + 1, n) = -(1.0 - a);
    loop(n + 1, n + 1) = a - 1.0;
  }
  // Each filter in the states w, delta w of delta^degree w + ... + d0 w = force; what leaves it is the next one's
  // force.
  for (const FilterSection& section : sections) {
    const auto degree = static_cast<Eigen::Index>(section.degree);
    const std::array<double, 3> numerator = whole_numerator(section);
    Eigen::RowVectorXd highest = force;  // delta^degree w
    for (Eigen::Index i = 0; i < degree; ++i) highest(next + i) -= section.denominator[static_cast<std::size_t>(i)];
    for (Eigen::Index i = 0; i + 1 < degree; ++i) loop(next + i, next + i + 1) = 1.0;
    loop.row(next + degree - 1) = highest;
    force = numerator[section.degree] * highest;
    for (Eigen::Index i = 0; i < degree; ++i) force(next + i) += numerator[static_cast<std::size_t>(i)];
    next += degree;
  }
  Eigen::VectorXd input = Eigen::VectorXd::Zero(order);
  input.head(n) = device.Gamma1;
  return {std::move(loop), std::move(input), std::move(force)};
}

std::vector<std::complex<double>> balanced_eigenvalues(const Eigen::MatrixXd& loop) {
  const Eigen::VectorXd scales = balancing_scales(loop);
  const Eigen::MatrixXd balanced = scales.cwiseInverse().asDiagonal() * loop * scales.asDiagonal();
  const Eigen::VectorXcd values = eigenvalues(balanced);
  return {values.data(), values.data() + values.size()};
}

double largest_excess(const std::vector<std::complex<double>>& poles_minus_one) {
  double largest = -1.0;
  for (const std::complex<double>& delta : poles_minus_one) {
    largest = std::max(largest, modulus_minus_one(delta));
  }
  return largest;
}

}  // namespace

std::vector<std::complex<double>> closed_loop_poles_minus_one(const DiscreteStateSpace& plant, const Wall& wall) {
  const OpenedLoop opened = opened_loop(plant, wall);
  return balanced_eigenvalues(opened.loop + opened.input * opened.force);
}

double stability_excess(const DiscreteStateSpace& plant, const Wall& wall, CountedPoles counted) {
  std::vector<std::complex<double>> poles = closed_loop_poles_minus_one(plant, wall);
  if (counted == CountedPoles::but_free_position) {
    const auto size = [](std::complex<double> delta) { return std::norm(delta); };
    poles.erase(std::ranges::min_element(poles, {}, size));
  }
  return largest_excess(poles);
}

double stability_excess_at_phase(const DiscreteStateSpace& plant, const Wall& wall, double phase) {
  const OpenedLoop opened = opened_loop(plant, wall);
  const Eigen::MatrixXd closing = opened.input * opened.force;
  const Eigen::MatrixXd real = opened.loop + std::cos(phase) * closing;
  const Eigen::MatrixXd imaginary = -std::sin(phase) * closing;
  // The eigenvalues of a complex matrix and of its conjugate, by a real one.
  Eigen::MatrixXd both(2 * real.rows(), 2 * real.rows());
  both << real, -imaginary, imaginary, real;
  return largest_excess(balanced_eigenvalues(both));
}

}  // namespace zwidth
