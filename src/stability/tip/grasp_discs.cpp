#include "stability/tip/grasp_discs.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "eigenvalues.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;
using ComplexNumber = std::complex<double>;

constexpr double past_modes = 2.5;    // aliases beyond this many times the highest mode are summed by the rule
constexpr double past_corners = 4.0;  // beyond this many times the highest corner frequency its tail begins
constexpr std::size_t least_aliases = 12;
constexpr double most_aliases = 2000.0;
constexpr double undamped_below = 1e-12;  // relative, of what the tip's motions dissipate

// Quicker than the division, which looks for what overflows.
ComplexNumber reciprocal(ComplexNumber value) { return std::conj(value) / std::norm(value); }

// The real part of n' form n by the products of n.
Eigen::Matrix<double, 1, 6> by_products(const Eigen::Matrix3cd& form) {
  Eigen::Matrix<double, 1, 6> row;
  row << form(0, 0).real(), form(1, 1).real(), form(2, 2).real(), form(0, 1).real() + form(1, 0).real(),
      form(0, 2).real() + form(2, 0).real(), form(1, 2).real() + form(2, 1).real();
  return row;
}

// (K - w^2 + jw D) x = b by elimination with row pivots, in place; columns of `b` side by side.
void solve_motion(Eigen::MatrixXcd& rows, Eigen::MatrixXcd& b) {
  const Eigen::Index n = rows.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      if (std::norm(rows(i, k)) > std::norm(rows(pivot, k))) pivot = i;
    }
    if (pivot != k) {
      for (Eigen::Index j = k; j < n; ++j) std::swap(rows(k, j), rows(pivot, j));
      for (Eigen::Index j = 0; j < b.cols(); ++j) std::swap(b(k, j), b(pivot, j));
    }
    const ComplexNumber one_over = reciprocal(rows(k, k));
    for (Eigen::Index i = k + 1; i < n; ++i) {
      const ComplexNumber factor = rows(i, k) * one_over;
      for (Eigen::Index j = k + 1; j < n; ++j) rows(i, j) -= factor * rows(k, j);
      for (Eigen::Index j = 0; j < b.cols(); ++j) b(i, j) -= factor * b(k, j);
    }
    rows(k, k) = one_over;
  }
  for (Eigen::Index k = n; k-- > 0;) {
    for (Eigen::Index j = 0; j < b.cols(); ++j) {
      for (Eigen::Index i = k + 1; i < n; ++i) b(k, j) -= rows(k, i) * b(i, j);
      b(k, j) *= rows(k, k);
    }
  }
}

}  // namespace

GraspDiscs::GraspDiscs(const TipMotion& motion, const DeviceParameters& loop, const Eigen::MatrixXd& directions,
                       const SampledTip& plant)
    : of_(tip_coordinates(motion, directions)),
      response_(plant),
      period_(loop.loop.sampling_period),
      delay_(loop.loop.delay),
      lag_(loop.actuator.time_constant) {
  // A grasp in one basis of the tip's motions is one in any other: in an orthonormal one near a singular pose no row is small.
  const Eigen::HouseholderQR<Eigen::MatrixXd> tip(of_.tip.transpose());
  of_.tip = (tip.householderQ() * Eigen::MatrixXd::Identity(of_.tip.cols(), of_.tip.rows())).transpose();
  const Eigen::VectorXd dampings = symmetric_eigenvalues(of_.damping);
  const Eigen::VectorXd stiffnesses = symmetric_eigenvalues(of_.stiffness);
  const double highest_mode = std::sqrt(std::max(stiffnesses.maxCoeff(), 0.0));
  double highest_corner = std::max({highest_mode, dampings.maxCoeff(), lag_ > 0.0 ? 1.0 / lag_ : 0.0});
  for (const Coordinates::Element& each : motion.elements) {
    if (each.damping > 0.0) highest_corner = std::max(highest_corner, each.stiffness / each.damping);
  }
  const double spacing = 2.0 * pi / period_;
  const auto exact =
      least_aliases + static_cast<std::size_t>(std::min(std::ceil(past_modes * highest_mode / spacing), most_aliases));
  rule_ = alias_sum_quadrature(exact, past_corners * highest_corner / spacing, spacing * delay_);
  undamped_ = !(dampings.maxCoeff() > 0.0);
  std::vector<double> looked_at{0.1 / period_, 1.0 / period_, pi / period_};
  for (const AliasSumQuadrature::Node& node : rule_.nodes) {
    if (node.number > 0.0) looked_at.push_back(node.number * spacing);
  }
  for (const double frequency : looked_at) {
    if (!undamped_) undamped_ = !alias(frequency).left.allFinite();
  }
}

// R = 2 w^2 g^H D g with g = G(held -> all), in which nothing cancels; R = L L^H.
GraspDiscs::Alias GraspDiscs::alias(double frequency) const {
  const Eigen::Matrix3cd endless = Eigen::Matrix3cd::Constant(HUGE_VAL);
  const Eigen::Index m = of_.tip.rows();
  Eigen::MatrixXcd rows = of_.stiffness.cast<ComplexNumber>();
  rows += ComplexNumber(0.0, frequency) * of_.damping;
  rows.diagonal().array() -= frequency * frequency;
  Eigen::MatrixXcd g = of_.tip.transpose().cast<ComplexNumber>();
  solve_motion(rows, g);
  const Eigen::MatrixXcd damped = of_.damping * g;
  Eigen::Matrix3cd r = Eigen::Matrix3cd::Zero();
  r.topLeftCorner(m, m) = 2.0 * frequency * frequency * (g.adjoint() * damped);
  const double size = r.norm();
  // Columns: L^-1 h_s^H, L^-1 h_a.
  Eigen::Matrix<ComplexNumber, 3, 6> both = Eigen::Matrix<ComplexNumber, 3, 6>::Zero();
  both.block(0, 0, m, m) = (of_.sensed * g).adjoint();
  both.block(0, 3, m, m) = (of_.pushed * g).transpose();
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      ComplexNumber entry = r(i, j);
      for (Eigen::Index k = 0; k < j; ++k) entry -= r(i, k) * std::conj(r(j, k));
      r(i, j) = entry / r(j, j).real();
      both.row(i) -= r(i, j) * both.row(j);
    }
    double square = r(i, i).real();
    for (Eigen::Index k = 0; k < i; ++k) square -= std::norm(r(i, k));
    if (!(square > undamped_below * size)) return {1.0, endless, endless, endless};
    r(i, i) = std::sqrt(square);
    both.row(i) /= r(i, i).real();
  }
  const Eigen::Matrix3cd left = both.leftCols<3>();
  const Eigen::Matrix3cd right = both.rightCols<3>();
  Alias alias{1.0, left.adjoint() * right, left.adjoint() * left, right.adjoint() * right};
  if (lag_ > 0.0) {
    const ComplexNumber lagged = 1.0 / ComplexNumber(1.0, lag_ * frequency);
    alias.shift *= lagged;
    alias.right *= std::norm(lagged);
  }
  return alias;
}

std::vector<ComplexNumber> GraspDiscs::held_poles() const {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> tip(of_.tip.transpose());
  const Eigen::Index n = of_.tip.cols() - tip.rank();
  const Eigen::MatrixXd q = tip.householderQ();
  const Eigen::MatrixXd still = q.rightCols(n);
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  motion.topRightCorner(n, n).diagonal().setConstant(1.0 / period_);
  motion.bottomLeftCorner(n, n) = -period_ * still.transpose() * of_.stiffness * still;
  motion.bottomRightCorner(n, n) = -still.transpose() * of_.damping * still;
  std::vector<ComplexNumber> poles;
  if (n == 0) return poles;
  for (const ComplexNumber& s : eigenvalues(motion)) poles.push_back(std::exp(s * period_));
  return poles;
}

GraspDiscs::Sample GraspDiscs::own_at(double angle) const {
  const Eigen::Index m = of_.tip.rows();
  Sample sample;
  sample.angle = angle;
  const double sine = std::sin(0.5 * angle);
  sample.shared =
      2.0 * sine / period_ * ComplexNumber(sine, std::cos(0.5 * angle)) * std::polar(1.0, -angle * delay_ / period_);
  sample.plant.setZero();
  sample.plant.topLeftCorner(m, m) = response_.at(angle);
  sample.own = alias(angle / period_);
  sample.shift_of_others.setZero();
  return sample;
}

GraspDiscs::Sample GraspDiscs::at(double angle) const {
  Sample sample = own_at(angle);
  const double spacing = 2.0 * pi / period_;
  sample.others.reserve(2 * rule_.nodes.size());
  for (std::size_t i = 1; i < rule_.nodes.size(); ++i) {
    const AliasSumQuadrature::Node& node = rule_.nodes[i];
    for (const double side : {1.0, -1.0}) {
      Alias other = alias(node.number * spacing + side * angle / period_);
      const Eigen::Matrix3cd shift = node.turning * other.shift;
      sample.shift_of_others += side > 0.0 ? shift : shift.conjugate();
      other.weight = node.still;
      if (side < 0.0) {  // of the negative frequency
        other.left = other.left.conjugate().eval();
        other.right = other.right.conjugate().eval();
      }
      sample.others.push_back(other);
    }
  }
  const auto count = static_cast<Eigen::Index>(sample.others.size());
  sample.left_forms.resize(count, 6);
  sample.right_forms.resize(count, 6);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Alias& other = sample.others[static_cast<std::size_t>(i)];
    sample.left_forms.row(i) = other.weight * other.weight * by_products(other.left);
    sample.right_forms.row(i) = by_products(other.right);
  }
  return sample;
}

}  // namespace zwidth::internal
