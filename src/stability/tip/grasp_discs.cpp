#include "stability/tip/grasp_discs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "eigenvalues.hpp"
#include "linear_systems.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;
using ComplexNumber = std::complex<double>;

constexpr double past_modes = 2.5;    // aliases beyond this many times the highest mode are summed by the rule
constexpr double past_corners = 4.0;  // beyond this many times the highest corner frequency its tail begins
constexpr std::size_t least_aliases = 12;
constexpr double most_aliases = 2000.0;
constexpr double undamped_below = 1e-12;   // of a motion of the tip, relative: what the motions before it do not damp
constexpr double rounded_damping = 1e-14;  // relative, of an eigenvalue of D that is rounding
// Of the greatest |sT|. Lossless points are squares, known to a share of 1e-16 of the greatest; beside points at rest, with which slow
// ones are hardly distinct, to its root.
constexpr double told_from_rounding = 1e-7;
constexpr double told_from_rest = 1e-4;
constexpr double no_spring_below = 1e-12;  // relative, of the springs of still motions
constexpr double least_damping = 1e-9;     // relative, of a motion that nothing damps, where R = 0 is sought

// Quicker than the division, which looks for what overflows.
template <typename Real>
std::complex<Real> reciprocal(std::complex<Real> value) {
  return std::conj(value) / std::norm(value);
}

// Products of few rows and columns are lazy: the blocked one takes the compiler seconds for each kind of number.
template <typename Real>
using ComplexMatrix = Eigen::Matrix<std::complex<Real>, Eigen::Dynamic, Eigen::Dynamic>;

// (K - w^2 + jw D) x = b by elimination with row pivots, in place; columns of `b` side by side.
template <typename Real>
void solve_motion(ComplexMatrix<Real>& rows, ComplexMatrix<Real>& b) {
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
    const std::complex<Real> one_over = reciprocal(rows(k, k));
    for (Eigen::Index i = k + 1; i < n; ++i) {
      const std::complex<Real> factor = rows(i, k) * one_over;
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

// Of l^2 x = P x + l Q x, given as [0 0; P Q]: of the companion in which x and l x are of one size. Else rounding of the greatest
// drowns the least.
Eigen::VectorXcd eigenvalues_of_second_order(Eigen::MatrixXd companion) {
  const Eigen::Index n = companion.rows() / 2;
  const double size = std::max(std::sqrt(companion.bottomLeftCorner(n, n).cwiseAbs().maxCoeff()),
                               companion.bottomRightCorner(n, n).cwiseAbs().maxCoeff());
  if (size == 0.0) return Eigen::VectorXcd::Zero(2 * n);
  companion.bottomLeftCorner(n, n) /= size;
  companion.topRightCorner(n, n) = size * Eigen::MatrixXd::Identity(n, n);
  return eigenvalues(companion);
}

// sT of z'' + D z' + K z = 0.
std::vector<ComplexNumber> motion_poles(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& damping,
                                        double period) {
  const Eigen::Index n = stiffness.rows();
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  motion.bottomLeftCorner(n, n) = -period * period * stiffness;
  motion.bottomRightCorner(n, n) = -period * damping;
  const Eigen::VectorXcd poles = eigenvalues_of_second_order(std::move(motion));
  return {poles.begin(), poles.end()};
}

template <typename Real>
struct OwnForms {
  Eigen::Matrix<std::complex<Real>, 3, 3> plant;  // G(pushed -> sensed)
  Eigen::Matrix<std::complex<Real>, 3, 3> sensed;
  Eigen::Matrix<std::complex<Real>, 3, 3> pushed;
  Eigen::Matrix<std::complex<Real>, 3, 3> shift;
  Eigen::Matrix<std::complex<Real>, 3, 3> left;
  Eigen::Matrix<std::complex<Real>, 3, 3> right;
};

// R = W^H W with W = sqrt(2) w F g, g = G(held -> all), D = F^T F, in which nothing cancels; R = L L^H by Gram and Schmidt: motions may
// be damped by magnitudes more and less than one another.
template <typename Real>
OwnForms<Real> own_forms(const TipCoordinates& of, const Eigen::MatrixXd& tip, const Eigen::MatrixXd& dampers,
                         double frequency, bool with_plant) {
  using Complex = std::complex<Real>;
  const Eigen::Index m = tip.rows();
  const auto w = static_cast<Real>(frequency);
  ComplexMatrix<Real> rows = of.stiffness.cast<Complex>();
  const Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>& f = dampers.cast<Real>();
  rows += Complex(0, w) * f.transpose().lazyProduct(f).template cast<Complex>();
  rows.diagonal().array() -= w * w;
  ComplexMatrix<Real> g(tip.cols(), with_plant ? 2 * m : m);
  g.leftCols(m) = tip.transpose().cast<Complex>();
  if (with_plant) g.rightCols(m) = of.pushed.transpose().cast<Complex>();
  solve_motion<Real>(rows, g);
  const ComplexMatrix<Real> held = g.leftCols(m);
  OwnForms<Real> forms;
  forms.plant.setZero();
  if (with_plant) forms.plant.topLeftCorner(m, m) = of.sensed.cast<Complex>().lazyProduct(g.rightCols(m));
  // Columns: L^-1 h_s^H, L^-1 h_a.
  Eigen::Matrix<Complex, 3, 6> both = Eigen::Matrix<Complex, 3, 6>::Zero();
  both.block(0, 0, m, m) = of.sensed.cast<Complex>().lazyProduct(held).adjoint();
  both.block(0, 3, m, m) = of.pushed.cast<Complex>().lazyProduct(held).transpose();
  ComplexMatrix<Real> damped = std::sqrt(static_cast<Real>(2)) * w * dampers.cast<Complex>().lazyProduct(held);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Real own = damped.col(i).norm();
    for (Eigen::Index j = 0; j < i; ++j) {
      const Complex shared = damped.col(j).dot(damped.col(i));
      damped.col(i) -= shared * damped.col(j);
      both.row(i) -= std::conj(shared) * both.row(j);
    }
    const Real rest = damped.col(i).norm();
    if (!(rest > static_cast<Real>(undamped_below) * own)) {
      forms.sensed = forms.pushed = Eigen::Matrix<Complex, 3, 3>::Constant(HUGE_VAL);
      forms.shift = forms.left = forms.right = forms.sensed;
      return forms;
    }
    damped.col(i) /= rest;
    both.row(i) /= rest;
  }
  forms.sensed = both.template leftCols<3>();
  forms.pushed = both.template rightCols<3>();
  forms.shift = forms.sensed.adjoint().lazyProduct(forms.pushed);
  forms.left = forms.sensed.adjoint().lazyProduct(forms.sensed);
  forms.right = forms.pushed.adjoint().lazyProduct(forms.pushed);
  return forms;
}

}  // namespace

GraspDiscs::GraspDiscs(const TipMotion& motion, const DeviceParameters& loop, const Eigen::MatrixXd& directions,
                       const SampledTip& plant)
    : of_(tip_coordinates(motion, directions)),
      response_(plant),
      period_(loop.loop.sampling_period),
      delay_(loop.loop.delay),
      drive_(drive_path_of(loop)) {
  // A grasp in one basis of the tip's motions is one in any other: in an orthonormal one near a singular pose no row is small.
  basis_ = orthonormal_basis(of_.tip.transpose(), 0.0).transpose();
  const auto [dampings, motions] = symmetric_eigen(of_.damping);
  const double none = rounded_damping * std::max(dampings.maxCoeff(), 0.0);
  dampers_ = (dampings.array() > none).select(dampings.array(), 0.0).sqrt().matrix().asDiagonal() * motions.transpose();
  const Eigen::VectorXd stiffnesses = symmetric_eigenvalues(of_.stiffness);
  const double highest_mode = std::sqrt(std::max(stiffnesses.maxCoeff(), 0.0));
  double highest_corner =
      std::max({highest_mode, dampings.maxCoeff(), drive_.lag > 0.0 ? 1.0 / drive_.lag : 0.0, drive_.tracking});
  for (const Coordinates::Element& each : motion.elements) {
    if (each.damping > 0.0) highest_corner = std::max(highest_corner, each.stiffness / each.damping);
  }
  const double spacing = 2.0 * pi / period_;
  const auto exact =
      least_aliases + static_cast<std::size_t>(std::min(std::ceil(past_modes * highest_mode / spacing), most_aliases));
  rule_ = alias_sum_quadrature(exact, past_corners * highest_corner / spacing, spacing * delay_);
  undamped_ = !(dampings.maxCoeff() > 0.0);
  const Sample low = own_at(low_angle);
  const double lowest = low_angle / period_;
  const OwnForms<Real> own = own_forms<Real>(of_, of_.tip, dampers_, lowest, true);
  const std::complex<Real> passed(drive_.is_ideal() ? 1.0 : drive_.response(lowest));
  others_plant_ = (low.centre - passed * (own.plant / std::complex<Real>(0, lowest) - own.shift)).cast<ComplexNumber>();
  std::vector<double> looked_at{0.1 / period_, 1.0 / period_, pi / period_};
  for (const AliasSumQuadrature::Node& node : rule_.nodes) {
    if (node.number > 0.0) looked_at.push_back(node.number * spacing);
  }
  for (const double frequency : looked_at) {
    if (!undamped_) undamped_ = !alias(frequency).left.allFinite();
  }
}

GraspDiscs::Alias GraspDiscs::alias(double frequency) const {
  const OwnForms<double> forms = own_forms<double>(of_, basis_, dampers_, frequency, false);
  Alias alias{1.0, forms.shift, forms.left, forms.right, forms.sensed, forms.pushed};
  if (!drive_.is_ideal()) {
    const ComplexNumber passed = drive_.response(frequency);
    alias.shift *= passed;
    alias.pushed *= passed;
    alias.right *= std::norm(passed);
  }
  return alias;
}

void GraspDiscs::add_low(Sample& sample) const {
  using Complex = std::complex<Real>;
  const double frequency = sample.angle / period_;
  const OwnForms<Real> forms = own_forms<Real>(of_, of_.tip, dampers_, frequency, true);
  const ComplexNumber drive = drive_.is_ideal() ? 1.0 : drive_.response(frequency);
  const Complex passed(drive);
  // Even and odd in the angle.
  Eigen::Matrix3cd others = others_plant_;
  others.imag() *= sample.angle / low_angle;
  sample.plant = passed * forms.plant / Complex(0, static_cast<Real>(frequency)) + others.cast<Complex>();
  sample.centre = sample.plant - passed * forms.shift;
  sample.left = forms.left.real();
  sample.right = std::norm(passed) * forms.right.real();
  sample.sensed = forms.sensed;
  sample.pushed = passed * forms.pushed;
}

void GraspDiscs::add_own(Sample& sample) const {
  using Complex = std::complex<Real>;
  const Eigen::Index m = of_.tip.rows();
  const double frequency = sample.angle / period_;
  constexpr double beside = 1.0 + 1e-9;
  sample.own = alias(frequency);
  // At a lossless point R = 0, and what the discs limit goes through it smoothly.
  if (!sample.own.left.allFinite()) sample.own = alias(frequency * beside);
  Eigen::Matrix3cd plant = Eigen::Matrix3cd::Zero();
  plant.topLeftCorner(m, m) = response_.at(sample.angle);
  sample.plant = (plant / sample.shared).cast<Complex>();
  sample.centre = sample.plant - sample.own.shift.cast<Complex>();
  sample.left = sample.own.left.real().cast<Real>();
  sample.right = sample.own.right.real().cast<Real>();
  sample.sensed = sample.own.sensed.cast<Complex>();
  sample.pushed = sample.own.pushed.cast<Complex>();
}

// Columns: an orthonormal basis of the motions in which the tip stands still.
Eigen::MatrixXd GraspDiscs::still_motions() const {
  return orthonormal_complement(of_.tip.transpose(), smallest_pivot);
}

std::vector<ComplexNumber> GraspDiscs::still_poles() const {
  const Eigen::MatrixXd still = still_motions();
  if (still.cols() == 0) return {};
  return motion_poles(still.transpose() * of_.stiffness * still, still.transpose() * of_.damping * still, period_);
}

// How many of these poles are at rest: one of each motion that no spring holds, two where nothing damps it. Rounding moves them by
// the square root of itself, so that no bound tells them from slow ones.
Eigen::Index GraspDiscs::still_at_rest() const {
  const Eigen::MatrixXd still = still_motions();
  const auto of_size_one = [&](const Eigen::MatrixXd& matrix) -> Eigen::MatrixXd {
    const Eigen::MatrixXd of_still = still.transpose() * matrix * still;
    const double size = of_still.cwiseAbs().maxCoeff();
    return size > 0.0 ? of_still / size : of_still;
  };
  const auto free_of = [](const Eigen::MatrixXd& forces) {
    return forces.cols() - (forces.isZero(0.0) ? 0 : rank(forces, no_spring_below));
  };
  if (still.cols() == 0) return 0;
  const Eigen::MatrixXd springs = of_size_one(of_.stiffness);
  return free_of(springs) + free_of(springs + of_size_one(of_.damping));
}

std::vector<ComplexNumber> GraspDiscs::free_poles() const {
  std::vector<ComplexNumber> poles = motion_poles(of_.stiffness, of_.damping, period_);
  std::erase_if(poles, [](const ComplexNumber& s) { return !(s.imag() > 0.0); });
  return poles;
}

std::vector<ComplexNumber> GraspDiscs::lossless_points() const {
  std::vector<ComplexNumber> points;
  if (drive_.lag > 0.0) points.emplace_back(-period_ / drive_.lag, 0.0);
  if (drive_.tracking > 0.0) points.emplace_back(-period_ * drive_.tracking, 0.0);
  const Eigen::MatrixXd still = still_motions();
  const Eigen::Index n = still.cols();
  if (n == 0 || undamped_) return points;
  Eigen::MatrixXd damping = period_ * of_.damping;
  damping.diagonal().array() += least_damping * damping.norm();
  const Eigen::MatrixXd stiffness = period_ * period_ * of_.stiffness;
  const Eigen::MatrixXd damped = inverse_of_symmetric(damping);
  const Eigen::MatrixXd moved = damped * still;               // D^-1 S
  const Eigen::MatrixXd sprung = damped * stiffness * still;  // D^-1 K S
  const Eigen::MatrixXd mixed = still.transpose() * stiffness * moved;
  const Eigen::MatrixXd leading = inverse_of_symmetric(still.transpose() * moved);
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  companion.bottomLeftCorner(n, n) = -leading * still.transpose() * stiffness * sprung;
  companion.bottomRightCorner(n, n) = -leading * (mixed + mixed.transpose() - still.transpose() * damping * still);
  // Each still motion that no spring holds leaves one point at rest, which rounding moves by the square root of itself.
  const Eigen::VectorXcd found = eigenvalues_of_second_order(std::move(companion));
  std::vector<ComplexNumber> squares(found.begin(), found.end());
  std::ranges::sort(squares, {}, [](const ComplexNumber& each) { return std::abs(each); });
  const Eigen::Index at_rest = stiffness.isZero(0.0) ? n : n - rank(stiffness * still, no_spring_below);
  squares.erase(squares.begin(), squares.begin() + at_rest);
  for (const ComplexNumber& square : squares) {
    const ComplexNumber root = std::sqrt(square);
    points.push_back(root.imag() >= 0.0 ? root : -root);
  }
  return points;
}

double GraspDiscs::slowest_corner() const {
  double slowest = std::numeric_limits<double>::infinity();
  std::vector<ComplexNumber> poles = still_poles();
  std::ranges::sort(poles, {}, [](const ComplexNumber& each) { return std::abs(each); });
  const auto rest = static_cast<std::size_t>(still_at_rest());
  if (rest < poles.size()) slowest = std::abs(poles[rest]);
  for (const ComplexNumber& s : lossless_points()) slowest = std::min(slowest, std::abs(s));
  // Without any spring the points at rest are as many independent motions, which rounding moves by no root.
  const double told = rest > 0 && !of_.stiffness.isZero(0.0) ? told_from_rest : told_from_rounding;
  const bool is_rounding = !poles.empty() && slowest < told * std::abs(poles.back());
  return is_rounding ? 0.0 : slowest;
}

GraspDiscs::Sample GraspDiscs::own_at(double angle) const {
  Sample sample;
  sample.angle = angle;
  const double sine = std::sin(0.5 * angle);
  sample.shared =
      2.0 * sine / period_ * ComplexNumber(sine, std::cos(0.5 * angle)) * std::polar(1.0, -angle * delay_ / period_);
  add_own(sample);
  if (angle < low_angle) add_low(sample);
  return sample;
}

GraspDiscs::Others GraspDiscs::others_at(double angle) const {
  Others others;
  const double spacing = 2.0 * pi / period_;
  others.blocks.reserve(2 * rule_.nodes.size());
  for (std::size_t i = 1; i < rule_.nodes.size(); ++i) {
    const AliasSumQuadrature::Node& node = rule_.nodes[i];
    for (const double side : {1.0, -1.0}) {
      Alias other = alias(node.number * spacing + side * angle / period_);
      other.shift *= node.turning;
      other.weight = node.still;
      if (side < 0.0) {  // of the negative frequency
        other.left = other.left.conjugate().eval();
        other.right = other.right.conjugate().eval();
        other.shift = other.shift.conjugate().eval();
        other.sensed = other.sensed.conjugate().eval();
        other.pushed = other.pushed.conjugate().eval();
      }
      others.shift += other.shift;
      others.blocks.push_back(other);
    }
  }
  const auto count = static_cast<Eigen::Index>(others.blocks.size());
  others.left_forms.resize(count, 6);
  others.right_forms.resize(count, 6);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Alias& other = others.blocks[static_cast<std::size_t>(i)];
    others.left_forms.row(i) = other.weight * other.weight * by_products(other.left.real());
    others.right_forms.row(i) = by_products(other.right.real());
  }
  return others;
}

GraspDiscs::Sample GraspDiscs::at(double angle) const {
  Sample sample = own_at(angle);
  sample.others = others_at(angle);
  return sample;
}

Eigen::Matrix<double, 6, 1> products_of(const Eigen::Vector3d& normal) {
  Eigen::Matrix<double, 6, 1> products;
  products << normal.x() * normal.x(), normal.y() * normal.y(), normal.z() * normal.z(), normal.x() * normal.y(),
      normal.x() * normal.z(), normal.y() * normal.z();
  return products;
}

}  // namespace zwidth::internal
