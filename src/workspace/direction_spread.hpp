#pragma once

// Directions of the tip, and where between those tried a limit is least.

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

namespace zwidth::internal {

// Orthonormal columns: the directions in which the tip can move, by the rank that walls along one of them ask. In a plane the
// first is as near as can be to one of the world's axes, x before y and z, and the second a quarter turn from it.
[[nodiscard]] Eigen::MatrixXd moved_directions(const Eigen::MatrixXd& tip);

// So many, n and -n being one: even on a half circle from the first column on, on a half sphere by Fibonacci's spiral.
[[nodiscard]] std::vector<Eigen::Vector3d> spread_directions(const Eigen::MatrixXd& moved, std::size_t count);

// Those of a list that are walls of their own, in their order: n, -n and 2 n are one.
[[nodiscard]] std::vector<Eigen::Vector3d> distinct_walls(const std::vector<Eigen::Vector3d>& normals);

// The spread that a count of 0 stands for.
[[nodiscard]] std::size_t usual_directions(Eigen::Index moved);

// Orthonormal directions of `all` that are none of `left`.
[[nodiscard]] std::vector<Eigen::Vector3d> directions_beside(const Eigen::MatrixXd& all, const Eigen::MatrixXd& left);

// A normal along which a function is less than along all those tried, or as small.
struct LeastDirection {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double value = 0.0;
};

// Refines what is low among `tried`, of which the function's values are known; some 10 values a low in a plane and 30 in
// space. Infinite values are large ones. Where the function `may_jump` as limits with nobody holding do, what lies between neighbours
// that differ is looked at, too: some 1 degree in a plane, 5 in space. `tried` must not be empty.
[[nodiscard]] LeastDirection least_direction(const std::vector<Eigen::Vector3d>& tried,
                                             const std::vector<double>& values, const Eigen::MatrixXd& moved,
                                             const std::function<double(const Eigen::Vector3d&)>& function,
                                             bool may_jump);

}  // namespace zwidth::internal
