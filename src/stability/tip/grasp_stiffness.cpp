#include "stability/tip/grasp_stiffness.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "eigenvalues.hpp"
#include "stability/loop/damper_response.hpp"
#include "stability/users/disc_stiffness.hpp"

namespace zwidth::internal {
namespace {

constexpr double real_to = 1e-9;  // an eigenvalue's imaginary part, relative

double radius_along(const GraspDiscs::Alias& alias, const Eigen::Vector3d& normal) {
  const double left = normal.dot(alias.left.real() * normal);
  const double right = normal.dot(alias.right.real() * normal);
  return alias.weight * std::sqrt(std::max(left * right, 0.0));
}

// [1 + (K + d) c] x = (K + d) LL^H y,  [1 + (K + conj d) c^H] y = (K + conj d) R^H R x: the least real K > 0.
double least_of_block(const Eigen::MatrixXcd& centre, const Eigen::MatrixXcd& left, const Eigen::MatrixXcd& right,
                      std::complex<double> damper) {
  const Eigen::Index m = centre.rows();
  Eigen::MatrixXcd n(2 * m, 2 * m);
  n << centre, -left, -right, centre.adjoint();
  Eigen::MatrixXcd closed = n;
  closed.topRows(m) *= damper;
  closed.bottomRows(m) *= std::conj(damper);
  closed.diagonal().array() += 1.0;
  double least = std::numeric_limits<double>::infinity();
  const Eigen::MatrixXcd quotient = closed.partialPivLu().solve(n);
  for (const std::complex<double>& each : complex_eigenvalues(quotient)) {
    if (each.real() < 0.0 && std::abs(each.imag()) <= real_to * std::abs(each)) {
      least = std::min(least, -1.0 / each.real());
    }
  }
  return least;
}

}  // namespace

OthersAlong others_along(const GraspDiscs::Sample& sample, const Eigen::Vector3d& normal) {
  Eigen::Matrix<double, 6, 1> products;
  products << normal.x() * normal.x(), normal.y() * normal.y(), normal.z() * normal.z(), normal.x() * normal.y(),
      normal.x() * normal.z(), normal.y() * normal.z();
  const auto squares = (sample.left_forms * products).array() * (sample.right_forms * products).array();
  return {(normal.transpose() * sample.shift_of_others * normal).value(), squares.cwiseMax(0.0).sqrt().sum()};
}

double least_stiffness_along(const GraspDiscs::Sample& sample, const OthersAlong& others, const Eigen::Vector3d& normal,
                             VirtualDamper damper, double period) {
  const std::complex<double> shift = (normal.transpose() * sample.own.shift * normal).value() + others.shift;
  const std::complex<double> centre = (normal.transpose() * sample.plant * normal).value() - sample.shared * shift;
  const double radius = std::abs(sample.shared) * (radius_along(sample.own, normal) + others.radius);
  const double power = (std::abs(centre) - radius) * (std::abs(centre) + radius);  // |c|^2 - r^2
  const std::complex<double> closed = damper_response(damper, period, sample.angle / period);
  return least_root(1.0 + 2.0 * (closed * centre).real() + power * std::norm(closed),
                    centre.real() + power * closed.real(), power);
}

PointStiffness least_stiffness_of_point(const GraspDiscs::Sample& sample, Eigen::Index m, VirtualDamper damper,
                                        double period) {
  const double shared = std::abs(sample.shared);
  const Eigen::MatrixXcd centre =
      (sample.plant - sample.shared * (sample.own.shift + sample.shift_of_others)).topLeftCorner(m, m);
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
  add(sample.own);
  least.at_most = least_of_block(centre, left, right, closed);
  for (const GraspDiscs::Alias& each : sample.others) add(each);
  least.at_least = least_of_block(centre, left, right, closed);
  return least;
}

}  // namespace zwidth::internal
