#include "model/known_structure.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>

namespace zwidth::internal {
namespace {

Eigen::Map<const Eigen::VectorXd> as_vector(const std::vector<double>& weights) {
  return {weights.data(), static_cast<Eigen::Index>(weights.size())};
}

// M^-1 w of a point.
Eigen::VectorXd begun_at(const Coordinates& coordinates, std::size_t point) {
  const auto n = static_cast<Eigen::Index>(coordinates.size());
  const Eigen::Map<const Eigen::MatrixXd> mass(coordinates.mass.data(), n, n);  // symmetric
  return mass.llt().solve(as_vector(coordinates.points[point].weights));
}

// Of coordinates the motion that a slow force at a point makes, in which stiff cables hardly stretch: (K + s^2 M)^-1 w.
Eigen::VectorXd slow_motion(const Device& device, std::size_t point) {
  constexpr double slow = 1e-3;  // rad per sample
  const Coordinates& coordinates = *device.parameters().coordinates;
  const auto n = static_cast<Eigen::Index>(coordinates.size());
  const double rate = slow / device.loop().sampling_period;
  Eigen::MatrixXd sum = rate * rate * Eigen::Map<const Eigen::MatrixXd>(coordinates.mass.data(), n, n);
  for (const Coordinates::Element& each : coordinates.elements) {
    const auto along = as_vector(each.weights);
    sum += each.stiffness * along * along.transpose();
  }
  return sum.llt().solve(as_vector(coordinates.points[point].weights));
}

}  // namespace

double moving_mass(const Device& device) {
  if (const auto& coordinates = device.parameters().coordinates) {
    const std::size_t held = device.loop().held;
    return 1.0 / as_vector(coordinates->points[held].weights).dot(begun_at(*coordinates, held));
  }
  double mass = 0.0;
  for (const Body& body : device.bodies()) mass += body.mass;
  return mass;
}

double dry_friction(const Device& device) {
  double friction = 0.0;
  if (const auto& coordinates = device.parameters().coordinates) {
    const std::size_t actuated = device.loop().actuated;
    const Eigen::VectorXd motion = slow_motion(device, actuated);
    for (const Coordinates::Friction& each : coordinates->frictions) {
      friction += each.force * std::abs(as_vector(each.weights).dot(motion));
    }
    return friction / std::abs(as_vector(coordinates->points[actuated].weights).dot(motion));
  }
  for (const Body& body : device.bodies()) friction += body.coulomb;
  return friction;
}

}  // namespace zwidth::internal
