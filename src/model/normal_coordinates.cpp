#include "model/normal_coordinates.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "eigenvalues.hpp"
#include "model/device_matrices.hpp"

namespace zwidth::internal {
namespace {

// Relative: lengths that depend on the others to this are sums of them.
constexpr double dependent_below = 1e-9;
// Relative to force and position: a motion that is pushed or seen by less is not.
constexpr double unseen_below = 1e-10;

using Columns = std::vector<Eigen::VectorXd>;

struct Span {
  Eigen::MatrixXd basis;  // orthonormal and square: first what no column reaches, then what they span
  Eigen::Index beyond = 0;
};

// Of columns alike in size, some of which may be what rounding leaves of 0.
Span span_beyond(const Eigen::MatrixXd& columns, double rounding) {
  const Eigen::Index size = columns.rows();
  if (columns.size() == 0) return {Eigen::MatrixXd::Identity(size, size), size};
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  qr.setThreshold(std::max(dependent_below, rounding / std::max(qr.maxPivot(), rounding)));
  const Eigen::Index rank = qr.maxPivot() > rounding ? qr.rank() : 0;
  const Eigen::MatrixXd q = qr.householderQ();
  Span span{Eigen::MatrixXd(size, size), size - rank};
  span.basis << q.rightCols(size - rank), q.leftCols(rank);
  return span;
}

// However stiff or weak each is: by direction alone.
Span span_of(const Columns& columns, Eigen::Index size) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) all.col(static_cast<Eigen::Index>(i)) = columns[i].normalized();
  return span_beyond(all, 0.0);
}

void add(Eigen::MatrixXd& sum, double factor, const Eigen::VectorXd& weights) {
  if (factor > 0.0) sum += factor * weights * weights.transpose();
}

}  // namespace

Eigen::VectorXd NormalCoordinates::of(const Weights& weights) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(shapes.cols());
  for (const auto& [coordinate, weight] : weights) {
    sum += weight * shapes.row(static_cast<Eigen::Index>(coordinate)).transpose();
  }
  return sum;
}

NormalCoordinates normal_coordinates(const Device& device) {
  const DeviceMatrices<double> matrices = device_matrices<double>(device);
  const auto n = static_cast<Eigen::Index>(matrices.mass.size());
  Eigen::MatrixXd mass = Eigen::Map<const Eigen::MatrixXd>(matrices.coupling.data(), n, n);
  mass.diagonal() += Eigen::Map<const Eigen::VectorXd>(matrices.mass.data(), n);
  NormalCoordinates result;
  result.shapes = Eigen::LLT<Eigen::MatrixXd>(mass).matrixU().solve(Eigen::MatrixXd::Identity(n, n));

  const User& user = device.parameters().user;
  std::vector<DeviceLength> lengths = lengths_of(device);
  lengths.push_back({weights_of(device, device.loop().held), user.stiffness, user.damping});
  Columns springs;
  for (const DeviceLength& each : lengths) {
    if (each.stiffness > 0.0) springs.push_back(result.of(each.weights));
  }
  const Span sprung = span_of(springs, n);
  result.shapes *= sprung.basis;
  result.free = sprung.beyond;
  result.stiffness = result.damping = Eigen::MatrixXd::Zero(n, n);
  Columns dampers;
  for (const DeviceLength& each : lengths) {
    Eigen::VectorXd along = result.of(each.weights);
    if (each.stiffness > 0.0) along.head(result.free).setZero();  // but for rounding they are
    add(result.stiffness, each.stiffness, along);
    add(result.damping, each.damping, along);
    const Eigen::VectorXd free = along.head(result.free);
    if (each.damping > 0.0 && free.norm() > dependent_below * along.norm()) dampers.push_back(free);
  }
  const Span damped = span_of(dampers, result.free);
  result.loose = damped.beyond;
  result.damped = damped.basis.rightCols(result.free - damped.beyond);
  return result;
}

UnseenFirst unseen_first(const NormalCoordinates& of, const Eigen::MatrixXd& positions) {
  const Eigen::Index n = of.shapes.cols();
  UnseenFirst result{.turn = Eigen::MatrixXd::Identity(n, n)};
  const Span seen = span_beyond(positions.leftCols(of.free).transpose(), unseen_below * positions.norm());
  result.unseen = seen.beyond;
  const Eigen::MatrixXd unseen = seen.basis.leftCols(seen.beyond);
  const Span damped = span_beyond(unseen.transpose() * of.damped, dependent_below);
  result.adrift = damped.beyond;
  result.turn.topLeftCorner(of.free, of.free) << unseen * damped.basis, seen.basis.rightCols(of.free - seen.beyond);
  return result;
}

std::size_t poles_at_zero_seen(const NormalCoordinates& of, const Weights& force_at, const Weights& position_of) {
  const Eigen::VectorXd force = of.of(force_at);
  const Eigen::VectorXd position = of.of(position_of);
  const double least = unseen_below * force.norm() * position.norm();
  if (of.free == 0) return 0;
  const SymmetricEigen damping = symmetric_eigen(of.damping.topLeftCorner(of.free, of.free));
  const Eigen::VectorXd products = (damping.vectors.transpose() * force.head(of.free))
                                       .cwiseProduct(damping.vectors.transpose() * position.head(of.free));
  if (std::abs(products.head(of.loose).sum()) > least) return 2;
  double sum = 0.0;
  double largest = 0.0;
  for (Eigen::Index i = of.loose; i < of.free; ++i) {
    sum += products(i) / damping.values(i);
    largest = std::max(largest, std::abs(products(i)) > least ? std::abs(products(i) / damping.values(i)) : 0.0);
  }
  return std::abs(sum) > unseen_below * largest && largest > 0.0 ? 1 : 0;
}

}  // namespace zwidth::internal
