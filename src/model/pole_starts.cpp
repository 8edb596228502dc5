#include "model/pole_starts.hpp"

#include <algorithm>
#include <cmath>

#include "eigenvalues.hpp"
#include "model/normal_coordinates.hpp"

namespace zwidth::internal {
namespace {

using ComplexD = Complex<double>;

UndampedModes modes_of_coordinates(const Device& device) {
  const NormalCoordinates normal = normal_coordinates(device);
  const Eigen::Index held = normal.stiffness.rows() - normal.free;
  UndampedModes modes;
  if (normal.free > 0) {
    const Eigen::MatrixXd damping = normal.damping.topLeftCorner(normal.free, normal.free);
    for (const double each : symmetric_eigenvalues(damping)) modes.damping.push_back(std::max(each, 0.0));
    modes.stiffness.assign(modes.damping.size(), 0.0);
  }
  SymmetricEigen sprung;
  if (held > 0) sprung = symmetric_eigen(normal.stiffness.bottomRightCorner(held, held));
  for (Eigen::Index k = 0; k < held; ++k) {
    const auto shape = sprung.vectors.col(k);
    modes.stiffness.push_back(std::max(sprung.values(k), 0.0));
    modes.damping.push_back(std::max(shape.dot(normal.damping.bottomRightCorner(held, held) * shape), 0.0));
  }
  modes.lowest_mode_is_rigid = modes.stiffness.size() == 1;
  modes.damped_free = static_cast<std::size_t>(normal.free - normal.loose);
  return modes;
}

}  // namespace

std::pair<ComplexD, ComplexD> quadratic_roots(double c1, double c0) {
  const double half = c1 / 2.0;
  const double discriminant = half * half - c0;
  if (discriminant < 0.0) {
    const double imaginary = std::sqrt(-discriminant);
    return {ComplexD(-half, imaginary), ComplexD(-half, -imaginary)};
  }
  const double large = -(half + std::copysign(std::sqrt(discriminant), half));
  return {ComplexD(large), ComplexD(large != 0.0 ? c0 / large : 0.0)};
}

UndampedModes undamped_modes(const Device& device, const DeviceMatrices<double>& matrices) {
  if (!device.has_bodies()) return modes_of_coordinates(device);
  const auto n = static_cast<Eigen::Index>(matrices.mass.size());
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const RowMajor> stiffness(matrices.stiffness.data(), n, n);
  const Eigen::Map<const RowMajor> damping(matrices.damping.data(), n, n);
  const Eigen::VectorXd scale = Eigen::Map<const Eigen::VectorXd>(matrices.mass.data(), n).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd normalised = scale.asDiagonal() * stiffness * scale.asDiagonal();
  const SymmetricEigen solver = symmetric_eigen(normalised);
  const Eigen::MatrixXd shapes = scale.asDiagonal() * solver.vectors;
  UndampedModes modes;
  for (Eigen::Index k = 0; k < n; ++k) {
    modes.stiffness.push_back(std::max(solver.values(k), 0.0));
    modes.damping.push_back(std::max(shapes.col(k).dot(damping * shapes.col(k)), 0.0));
  }
  double in_links = 0.0;
  for (const Link& link : device.links()) {
    const double stretch =
        shapes(static_cast<Eigen::Index>(link.first), 0) - shapes(static_cast<Eigen::Index>(link.second), 0);
    in_links += link.stiffness * stretch * stretch;
  }
  double to_ground =
      device.parameters().user.stiffness * std::pow(shapes(static_cast<Eigen::Index>(device.loop().held), 0), 2);
  for (std::size_t i = 0; i < device.bodies().size(); ++i) {
    to_ground += device.bodies()[i].stiffness * std::pow(shapes(static_cast<Eigen::Index>(i), 0), 2);
  }
  modes.lowest_mode_is_rigid = to_ground >= in_links;
  return modes;
}

std::vector<ComplexD> newton_polygon_start(const std::vector<double>& p) {
  const std::size_t degree = p.size() - 1;
  std::vector<std::size_t> hull;
  for (std::size_t i = 0; i <= degree; ++i) {
    if (p[i] == 0.0) continue;
    const auto height = [&](std::size_t k) { return std::log(std::abs(p[k])); };
    const auto above = [&](std::size_t a, std::size_t b, std::size_t c) {  // is b on or under the line a-c?
      return (height(b) - height(a)) * static_cast<double>(c - a) <=
             (height(c) - height(a)) * static_cast<double>(b - a);
    };
    while (hull.size() >= 2 && above(hull[hull.size() - 2], hull.back(), i)) hull.pop_back();
    hull.push_back(i);
  }
  std::vector<ComplexD> start;
  for (std::size_t h = 0; h + 1 < hull.size(); ++h) {
    const std::size_t count = hull[h + 1] - hull[h];
    const double radius =
        std::exp((std::log(std::abs(p[hull[h]])) - std::log(std::abs(p[hull[h + 1]]))) / static_cast<double>(count));
    for (std::size_t i = 0; i < count; ++i) {
      const double angle =
          2.0 * M_PI * static_cast<double>(i) / static_cast<double>(count) + 0.7 + static_cast<double>(h);
      start.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
  }
  return start;
}

}  // namespace zwidth::internal
