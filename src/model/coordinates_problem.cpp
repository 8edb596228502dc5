#include "model/coordinates_problem.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "counted.hpp"
#include "eigenvalues.hpp"
#include "zwidth/model/device_key.hpp"

namespace zwidth::internal {
namespace {

// Of a mass matrix scaled to a diagonal of 1: below, its inverse keeps too few digits.
constexpr double least_eigenvalue = 1e-10;

bool is_number(double value) { return not_negative_numbers.contains(std::abs(value)); }

// Also what rounding leaves of 0, less than any number of a device.
bool is_share(double value) { return is_number(value) || std::abs(value) < not_negative_numbers.least; }

bool is_mass_matrix(const std::vector<double>& mass, std::size_t n) {
  if (mass.size() != n * n || !std::ranges::all_of(mass, is_share)) return false;
  const auto size = static_cast<Eigen::Index>(n);
  const Eigen::Map<const Eigen::MatrixXd> matrix(mass.data(), size, size);
  if (matrix != matrix.transpose() || !(matrix.diagonal().minCoeff() >= not_negative_numbers.least)) return false;
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  return symmetric_eigenvalues(scale.asDiagonal() * matrix * scale.asDiagonal()).minCoeff() > least_eigenvalue;
}

bool are_weights(const std::vector<double>& weights, std::size_t n) {
  return weights.size() == n && std::ranges::all_of(weights, is_share) &&
         std::ranges::any_of(weights, [](double w) { return w != 0.0 && is_number(w); });
}

}  // namespace

std::optional<DeviceProblem> find_coordinates_problem(const DeviceParameters& parameters) {
  const Coordinates& of = *parameters.coordinates;
  if (parameters.transfer_function || !parameters.bodies.empty() || !parameters.links.empty()) {
    return device_problem("coordinates", {.code = ProblemCode::beside_coordinates});
  }
  const std::size_t n = of.size();
  if (n == 0 || n > max_bodies) {
    return device_problem("coordinates", {.code = ProblemCode::coordinates_out_of_range,
                                          .evidence = {counted("count", n), counted("most", max_bodies)}});
  }
  const auto refused = [n](std::string key, ProblemCode code) {
    return device_problem(std::move(key), {.code = code, .evidence = {counted("count", n)}});
  };
  for (std::size_t i = 0; i < of.points.size(); ++i) {
    if (!are_weights(of.points[i].weights, n)) {
      return refused(fmt::format("coordinates.points.{}", i), ProblemCode::weights_not_one_a_coordinate);
    }
  }
  for (std::size_t i = 0; i < of.elements.size(); ++i) {
    const Coordinates::Element& element = of.elements[i];
    const std::string key = fmt::format("coordinates.elements.{}", i);
    if (!are_weights(element.weights, n)) return refused(key, ProblemCode::weights_not_one_a_coordinate);
    for (const double value : {element.stiffness, element.damping}) {
      if (not_negative_numbers.contains(value)) continue;
      return device_problem(
          key, {.code = ProblemCode::no_finite_number, .evidence = {{"value", value}, {"from_zero", 1.0}}});
    }
    if (element.stiffness == 0.0 && element.damping == 0.0) {
      return device_problem(key, {.code = ProblemCode::link_of_nothing});
    }
  }
  for (std::size_t i = 0; i < of.frictions.size(); ++i) {
    const std::string key = fmt::format("coordinates.frictions.{}", i);
    if (!are_weights(of.frictions[i].weights, n)) return refused(key, ProblemCode::weights_not_one_a_coordinate);
    const double force = of.frictions[i].force;
    if (not_negative_numbers.contains(force) && force > 0.0) continue;
    return device_problem(key, {.code = ProblemCode::no_finite_number, .evidence = {{"value", force}}});
  }
  if (of.tip) {
    const std::size_t poses = std::max<std::size_t>(of.tip->moved.size() / (3 * n), 1);
    const bool is_direction = std::ranges::all_of(of.tip->normal, [](double each) { return std::isfinite(each); });
    const bool is_right = is_direction && are_weights(of.tip->moved, poses * 3 * n) &&
                          are_weights(of.tip->sensed, 3 * n) && are_weights(of.tip->pushed, 3 * n);
    if (!is_right) return refused("coordinates.tip", ProblemCode::weights_not_one_a_coordinate);
  }
  if (!is_mass_matrix(of.mass, n)) return refused("coordinates.mass", ProblemCode::no_mass_matrix);
  return std::nullopt;
}

}  // namespace zwidth::internal
