#include "stability/tip/grasp_stiffness.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "eigenvalues.hpp"
#include "linear_systems.hpp"
#include "stability/loop/damper_response.hpp"

namespace zwidth::internal {
namespace {

constexpr double half_plane =
    1e24;                         // of a centre to the plant without the alias, squared: beyond, it is a lossless point
constexpr double real_to = 1e-9;  // an eigenvalue's imaginary part, relative

// Whether d [c + L U R] leaves the loop without a spring at the verge for some |U| <= 1: |R (1 + d c)^-1 d L| >= 1.
bool is_beaten_without_spring(const Eigen::MatrixXcd& centre, const Eigen::MatrixXcd& left,
                              const Eigen::MatrixXcd& right, std::complex<double> damper) {
  if (damper == 0.0) return false;
  Eigen::MatrixXcd closed = damper * centre;
  closed.diagonal().array() += 1.0;
  const Eigen::MatrixXcd far = solve_complex_columns(closed.adjoint(), right);
  const Eigen::MatrixXcd gain = std::norm(damper) * solve_complex_columns(closed, left) * far;
  return !(complex_eigenvalues(gain).cwiseAbs().maxCoeff() < 1.0);
}

// [1 + (K + d) c] x = (K + d) LL^H y,  [1 + (K + conj d) c^H] y = (K + conj d) R^H R x: the least real K > 0, or 0.
double least_of_block(const Eigen::MatrixXcd& centre, const Eigen::MatrixXcd& left, const Eigen::MatrixXcd& right,
                      std::complex<double> damper) {
  if (is_beaten_without_spring(centre, left, right, damper)) return 0.0;
  const Eigen::Index m = centre.rows();
  Eigen::MatrixXcd n(2 * m, 2 * m);
  n << centre, -left, -right, centre.adjoint();
  Eigen::MatrixXcd closed = n;
  closed.topRows(m) *= damper;
  closed.bottomRows(m) *= std::conj(damper);
  closed.diagonal().array() += 1.0;
  double least = std::numeric_limits<double>::infinity();
  const Eigen::MatrixXcd quotient = solve_complex_columns(closed, n);
  for (const std::complex<double>& each : complex_eigenvalues(quotient)) {
    if (each.real() < 0.0 && std::abs(each.imag()) <= real_to * std::abs(each)) {
      least = std::min(least, -1.0 / each.real());
    }
  }
  return least;
}

using Real = GraspDiscs::Real;
using LongComplex = std::complex<Real>;

// One alias along a normal: u^H v, |u| |v| and |u|^2 |v|^2 - |u^H v|^2.
struct OneAlias {
  LongComplex shift;
  Real radius = 0;
  Real apart = 0;
};

class AlongNormal {
 public:
  explicit AlongNormal(const Eigen::Vector3d& normal) : normal_(normal.cast<LongComplex>()) {}

  template <typename Columns>
  [[nodiscard]] Eigen::Matrix<LongComplex, 3, 1> of(const Columns& columns) const {
    return columns.template cast<LongComplex>() * normal_;
  }
  template <typename Form>
  [[nodiscard]] LongComplex of_form(const Form& form) const {
    return (normal_.transpose() * form.template cast<LongComplex>() * normal_).value();
  }
  template <typename Columns>
  [[nodiscard]] OneAlias alias(const Columns& sensed, const Columns& pushed) const {
    const auto u = of(sensed);
    const auto v = of(pushed);
    Real apart = 0;  // Lagrange's identity: nothing large cancels
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < i; ++j) apart += std::norm(u(i) * v(j) - u(j) * v(i));
    }
    return {u.dot(v), u.norm() * v.norm(), apart};
  }

 private:
  Eigen::Matrix<LongComplex, 3, 1> normal_;
};

// A plant less the shift of one alias, with its radius and `radius` of all else. Beside a lossless point of the alias its shift and
// radius grow alike, and |p - s|^2 - r^2 = |p|^2 - 2 Re(conj(p) s) - (r^2 - |s|^2) has their digits.
TerminationDiscs::Disc disc_of(std::complex<double> shared, LongComplex plant, LongComplex centre, const OneAlias& one,
                               Real radius) {
  const Real all = one.radius + radius;
  const Real power = std::norm(centre) <= std::norm(plant)
                         ? (std::abs(centre) - all) * (std::abs(centre) + all)
                         : std::norm(plant) - 2 * (std::conj(plant) * one.shift).real() - one.apart -
                               radius * (2 * one.radius + radius);
  const double size = std::abs(shared);
  const bool is_half_plane = std::norm(centre) > static_cast<Real>(half_plane) * std::norm(plant);
  return {shared * std::complex<double>(centre), size * static_cast<double>(all),
          size * size * static_cast<double>(power), is_half_plane ? 0.0 : 1.0};
}

}  // namespace

double radius_of_others(const GraspDiscs::Others& others, const Eigen::Matrix<double, 6, 1>& products) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < others.left_forms.rows(); ++i) {
    const double square = others.left_forms.row(i).dot(products) * others.right_forms.row(i).dot(products);
    sum += std::sqrt(std::max(square, 0.0));
  }
  return sum;
}

TerminationDiscs::Disc disc_along(const GraspDiscs::Sample& sample, const Eigen::Vector3d& normal) {
  const AlongNormal n(normal);
  const OneAlias own = n.alias(sample.sensed, sample.pushed);
  const std::vector<GraspDiscs::Alias>& others = sample.others.blocks;
  std::vector<Real> radii;
  radii.reserve(others.size());
  Real radius = 0;
  for (const GraspDiscs::Alias& each : others) {
    radii.push_back(static_cast<Real>(each.weight) * n.of(each.sensed).norm() * n.of(each.pushed).norm());
    radius += radii.back();
  }
  const auto widest = std::ranges::max_element(radii);
  const bool is_own = widest == radii.end() || *widest <= own.radius;
  if (is_own) {
    const LongComplex plant = n.of_form(sample.plant) - n.of_form(sample.others.shift);
    const LongComplex centre = n.of_form(sample.centre) - n.of_form(sample.others.shift);
    return disc_of(sample.shared, plant, centre, own, radius);
  }
  const auto at = static_cast<std::size_t>(widest - radii.begin());
  LongComplex plant = n.of_form(sample.centre);
  radius = own.radius;
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (i == at) continue;
    plant -= n.of_form(others[i].shift);
    radius += radii[i];
  }
  OneAlias one = n.alias(others[at].sensed, others[at].pushed);
  const auto weight = static_cast<Real>(others[at].weight);
  one = {n.of_form(others[at].shift), weight * one.radius, weight * weight * one.apart};
  return disc_of(sample.shared, plant, plant - one.shift, one, radius);
}

PointStiffness least_stiffness_of_point(const GraspDiscs::Sample& sample, Eigen::Index m, VirtualDamper damper,
                                        double period) {
  const double shared = std::abs(sample.shared);
  const Eigen::MatrixXcd centre =
      (sample.shared * (sample.centre.cast<std::complex<double>>() - sample.others.shift)).topLeftCorner(m, m);
  const std::complex<double> closed = damper_response(damper, period, sample.angle / period);
  Eigen::MatrixXcd left = Eigen::MatrixXcd::Zero(m, m);
  Eigen::MatrixXcd right = Eigen::MatrixXcd::Zero(m, m);
  // Each with both sides alike in size: of one direction their product is then the square of the sum of radii.
  const auto add = [&](const GraspDiscs::Alias& each) {
    const double size = each.left.norm() > 0.0 ? std::sqrt(each.right.norm() / each.left.norm()) : 1.0;
    if (!(size > 0.0)) return;
    left += shared * each.weight * size * each.left.topLeftCorner(m, m);
    right += shared * each.weight / size * each.right.topLeftCorner(m, m);
  };
  PointStiffness least;
  const auto is_known = [](const GraspDiscs::Alias& each) { return each.left.allFinite() && each.right.allFinite(); };
  if (!is_known(sample.own) || !std::ranges::all_of(sample.others.blocks, is_known)) return {0.0, 0.0};
  add(sample.own);
  least.at_most = least_of_block(centre, left, right, closed);
  for (const GraspDiscs::Alias& each : sample.others.blocks) add(each);
  least.at_least = least_of_block(centre, left, right, closed);
  return least;
}

}  // namespace zwidth::internal
