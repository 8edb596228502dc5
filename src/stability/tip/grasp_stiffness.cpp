#include "stability/tip/grasp_stiffness.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "eigenvalues.hpp"
#include "linear_systems.hpp"
#include "stability/loop/damper_response.hpp"

namespace zwidth::internal {
namespace {

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
  using Real = GraspDiscs::Real;
  const Eigen::Matrix<Real, 3, 1> n = normal.cast<Real>();
  const std::complex<Real> shift((normal.transpose() * sample.others.shift * normal).value());
  const std::complex<Real> centre = (n.transpose() * sample.centre.real() * n).value() - shift +
                                    std::complex<Real>(0, 1) * (n.transpose() * sample.centre.imag() * n).value();
  const Real left = n.dot(sample.left * n);
  const Real right = n.dot(sample.right * n);
  const Real radius = std::sqrt(std::max(left * right, Real(0))) + radius_of_others(sample.others, products_of(normal));
  const double size = std::abs(sample.shared);
  const Real power = (std::abs(centre) - radius) * (std::abs(centre) + radius);
  return {sample.shared * std::complex<double>(centre), size * static_cast<double>(radius),
          size * size * static_cast<double>(power), 1.0};
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
