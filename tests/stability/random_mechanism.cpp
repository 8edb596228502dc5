#include "stability/random_mechanism.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <complex>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "stability/matrix_products.hpp"

namespace zwidth::test {

void add_element(TipMotion& motion, const Eigen::VectorXd& along, double stiffness, double damping) {
  motion.elements.push_back({{along.begin(), along.end()}, stiffness, damping});
}

RandomMechanism random_mechanism(unsigned seed) {
  Draws draws(seed);
  const auto joints = static_cast<Eigen::Index>(draws.between(1.0, 4.3));
  const bool is_planar = draws.happens(0.4);
  const bool joints_are_read = draws.happens(0.3);
  Eigen::MatrixXd jacobian = 0.2 * draws.normal(3, joints);
  if (is_planar) jacobian.row(2).setZero();
  const Eigen::MatrixXd root = draws.normal(joints, joints);
  const Eigen::MatrixXd of_joints =
      draws.decades(5e-4, 5e-3) * (root * root.transpose() + 0.5 * Eigen::MatrixXd::Identity(joints, joints));
  RandomMechanism result;
  TipMotion& motion = result.motion;
  const Eigen::Index n = 2 * joints;
  motion.mass = Eigen::MatrixXd::Zero(n, n);
  motion.mass.topLeftCorner(joints, joints) = of_joints;
  motion.tip = motion.sensed = motion.pushed = Eigen::MatrixXd::Zero(3, n);
  motion.tip.leftCols(joints) = jacobian;
  for (Eigen::Index i = 0; i < joints; ++i) {
    const double ratio = draws.between(0.05, 0.3);
    motion.mass(joints + i, joints + i) = draws.decades(1e-5, 2e-4);
    const Eigen::VectorXd joint = Eigen::VectorXd::Unit(n, i);
    const Eigen::VectorXd motor = Eigen::VectorXd::Unit(n, joints + i);
    add_element(motion, joint, draws.happens(0.1) ? draws.decades(0.1, 10.0) : 0.0, draws.decades(5e-4, 1e-2));
    add_element(motion, motor, 0.0, draws.decades(5e-5, 5e-4));
    add_element(motion, ratio * motor - joint, draws.decades(30.0, 3000.0), draws.decades(5e-3, 0.2));
    motion.pushed.col(joints + i) = ratio * jacobian.col(i);
  }
  motion.sensed = joints_are_read ? motion.tip : motion.pushed;
  DeviceParameters& loop = result.loop;
  loop.loop.sampling_period = draws.decades(2e-4, 2e-3);
  if (draws.happens(0.6)) loop.loop.delay = loop.loop.sampling_period * draws.between(0.0, 2.5);
  if (draws.happens(0.3)) loop.actuator.time_constant = draws.decades(1e-4, 1e-3);
  if (draws.happens(0.4)) {
    loop.wall.damping = draws.decades(0.05, 1.0);
    if (draws.happens(0.5)) loop.wall.velocity_filter_hz = draws.decades(30.0, 300.0);
  }
  return result;
}

TipMotion randomly_held(const TipMotion& motion, double frequency, Draws& draws) {
  TipMotion held = motion;
  const double mass = draws.decades(1e-3, 3.0);
  const auto directions = [&] { return static_cast<int>(draws.between(0.0, 3.5)); };
  const auto along = [&] { return (motion.tip.transpose() * draws.normal(3, 1)).eval(); };
  for (int i = directions(); i > 0; --i) {
    const Eigen::VectorXd of = along();
    held.mass += draws.decades(0.01, 1.0) * mass * of * of.transpose();
  }
  for (int i = directions(); i > 0; --i) {
    add_element(held, along(), draws.decades(0.03, 3.0) * mass * frequency * frequency, 0.0);
  }
  if (draws.happens(0.4)) add_element(held, along(), 0.0, draws.decades(0.003, 1.0) * mass * frequency);
  if (!draws.happens(0.4)) return held;
  const Eigen::Index n = held.mass.rows();
  const double absorber = draws.decades(0.01, 1.0) * mass;
  held.mass.conservativeResizeLike(Eigen::MatrixXd::Zero(n + 1, n + 1));
  held.mass(n, n) = absorber;
  for (Coordinates::Element& each : held.elements) each.weights.push_back(0.0);
  for (Eigen::MatrixXd* rows : {&held.sensed, &held.pushed, &held.tip}) {
    rows->conservativeResizeLike(Eigen::MatrixXd::Zero(3, n + 1));
  }
  Eigen::VectorXd stretch = -Eigen::VectorXd::Unit(n + 1, n);
  stretch.head(n) = along();
  add_element(held, stretch, draws.decades(0.2, 5.0) * absorber * frequency * frequency,
              draws.happens(0.5) ? draws.decades(1e-4, 0.1) * absorber * frequency : 0.0);
  return held;
}

Eigen::MatrixXd balanced(Eigen::MatrixXd a) {
  constexpr double worth_scaling = 0.95;
  for (bool is_scaled = true; is_scaled;) {
    is_scaled = false;
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const double row = a.row(i).lpNorm<1>() - std::abs(a(i, i));
      const double column = a.col(i).lpNorm<1>() - std::abs(a(i, i));
      if (!(row > 0.0) || !(column > 0.0)) continue;
      const double scale = std::exp2(std::round(0.5 * std::log2(row / column)));
      if (!(column * scale + row / scale < worth_scaling * (column + row))) continue;
      a.col(i) *= scale;
      a.row(i) /= scale;
      is_scaled = true;
    }
  }
  return a;
}

SecondRoute::SecondRoute(const TipMotion& motion, const DeviceParameters& loop, const Eigen::MatrixXd& directions) {
  const Eigen::Index n = motion.mass.rows();
  const Eigen::Index m = directions.cols();
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd damping = stiffness;
  for (const Coordinates::Element& each : motion.elements) {
    const Eigen::Map<const Eigen::VectorXd> along(each.weights.data(), n);
    stiffness += each.stiffness * along * along.transpose();
    damping += each.damping * along * along.transpose();
  }
  const Eigen::MatrixXd inverse = motion.mass.inverse();
  const double lag = loop.actuator.time_constant;
  const Eigen::Index lags = lag > 0.0 ? m : 0;
  const Eigen::Index states = 2 * n + lags;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(states + m, states + m);  // with the force, which is held
  a.block(0, n, n, n).setIdentity();
  a.block(n, 0, n, n) = -inverse * stiffness;
  a.block(n, n, n, n) = -inverse * damping;
  a.block(n, 2 * n, n, m) = inverse * (directions.transpose() * motion.pushed).transpose();
  if (lags > 0) {
    a.block(2 * n, 2 * n, m, m).diagonal().setConstant(-1.0 / lag);
    a.block(2 * n, 2 * n + m, m, m).diagonal().setConstant(1.0 / lag);
  }
  const double period = loop.loop.sampling_period;
  const double whole = std::floor(loop.loop.delay / period + 1e-12);
  const double late = std::max(loop.loop.delay - whole * period, 0.0);
  const Eigen::MatrixXd first = (a * late).exp();
  const Eigen::MatrixXd second = (a * (period - late)).exp();
  const auto kept = static_cast<Eigen::Index>(whole) + 1;  // forces of the past
  const bool is_damped = loop.wall.damping > 0.0;
  const double pole =
      loop.wall.velocity_filter_hz > 0.0 ? std::exp(-2.0 * M_PI * loop.wall.velocity_filter_hz * period) : 0.0;
  const Eigen::Index size = states + kept * m + 2 * m;
  base_ = Eigen::MatrixXd::Zero(size, size);
  base_.topLeftCorner(states, states) = second.topLeftCorner(states, states) * first.topLeftCorner(states, states);
  const Eigen::MatrixXd old =
      second.topLeftCorner(states, states) * first.topRightCorner(states, m);  // u[k - whole - 1]
  const Eigen::MatrixXd now = second.topRightCorner(states, m);                // u[k - whole]
  Eigen::MatrixXd input = Eigen::MatrixXd::Zero(size, m);
  base_.block(0, states + (kept - 1) * m, states, m) += old;
  if (kept == 1) {
    input.topRows(states) = now;
  } else {
    base_.block(0, states + (kept - 2) * m, states, m) += now;
  }
  input.middleRows(states, m).setIdentity();
  for (Eigen::Index i = 1; i < kept; ++i) base_.block(states + i * m, states + (i - 1) * m, m, m).setIdentity();
  Eigen::MatrixXd output = Eigen::MatrixXd::Zero(m, size);
  output.leftCols(n) = directions.transpose() * motion.sensed;
  const Eigen::Index last = states + kept * m;
  Eigen::MatrixXd velocity = (1.0 - pole) / period * output;
  velocity.middleCols(last, m).diagonal().array() -= (1.0 - pole) / period;
  velocity.rightCols(m).diagonal().array() += pole;
  base_.middleRows(last, m) = output;
  base_.bottomRows(m) = velocity;
  damped_ = is_damped ? Eigen::MatrixXd(loop.wall.damping * input * velocity) : Eigen::MatrixXd::Zero(size, size);
  base_ -= damped_;
  slope_ = input * output;
}

double SecondRoute::radius(double stiffness) const {
  constexpr double at_one = 1e-8;
  double largest = 0.0;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(balanced(base_ - stiffness * slope_), false);
  for (const std::complex<double>& z : solver.eigenvalues()) {
    if (std::abs(z - 1.0) > at_one) largest = std::max(largest, std::abs(z));
  }
  return largest;
}

double SecondRoute::radius_turned(double stiffness, double phase, double factor) const {
  constexpr double at_one = 1e-8;
  double largest = 0.0;
  const std::complex<double> turned = std::polar(factor, -phase) - 1.0;
  const Eigen::MatrixXd wall = damped_ + stiffness * slope_;
  const Eigen::MatrixXd open = base_ - stiffness * slope_;
  const Eigen::MatrixXcd closed = complex_of(open) - turned * complex_of(wall);
  for (const std::complex<double>& z : eigenvalues_of(closed)) {
    if (std::abs(z - 1.0) > at_one) largest = std::max(largest, std::abs(z));
  }
  return largest;
}

}  // namespace zwidth::test
