#pragma once

#include <Eigen/Core>

#include "stability/tip/grasp_discs.hpp"
#include "stability/users/termination_discs.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth::internal {

// The sum over all aliases but the frequency's own of their radii along a normal, over `shared`.
[[nodiscard]] double radius_of_others(const GraspDiscs::Others& others, const Eigen::Matrix<double, 6, 1>& products);

// What the plant is along the normal in any grasp, at this frequency.
[[nodiscard]] TerminationDiscs::Disc disc_along(const GraspDiscs::Sample& sample, const Eigen::Vector3d& normal);

// Of a point wall in the first m directions, where all blocks count as one, and where the others stand at their centres.
struct PointStiffness {
  double at_least = 0.0;
  double at_most = 0.0;
};
[[nodiscard]] PointStiffness least_stiffness_of_point(const GraspDiscs::Sample& sample, Eigen::Index m,
                                                      VirtualDamper damper, double period);

}  // namespace zwidth::internal
