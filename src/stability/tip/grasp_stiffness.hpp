#pragma once

#include <Eigen/Core>
#include <complex>

#include "stability/tip/grasp_discs.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth::internal {

// What all aliases but the frequency's own add along a normal, over `shared`.
struct OthersAlong {
  std::complex<double> shift;
  double radius = 0.0;
};
[[nodiscard]] OthersAlong others_along(const GraspDiscs::Sample& sample, const Eigen::Vector3d& normal);

// What the plant is along the normal in any grasp, at this frequency.
[[nodiscard]] GraspedPlant::Disc disc_along(const GraspDiscs::Sample& sample, const OthersAlong& others,
                                            const Eigen::Vector3d& normal);

// The least K > 0 that some grasp destabilises at this frequency; infinity where there is none.
[[nodiscard]] double least_stiffness_along(const GraspDiscs::Sample& sample, const OthersAlong& others,
                                           const Eigen::Vector3d& normal, VirtualDamper damper, double period);

// Of a point wall in the first m directions, where all blocks count as one, and where the others stand at their centres.
struct PointStiffness {
  double at_least = 0.0;
  double at_most = 0.0;
};
[[nodiscard]] PointStiffness least_stiffness_of_point(const GraspDiscs::Sample& sample, Eigen::Index m,
                                                      VirtualDamper damper, double period);

}  // namespace zwidth::internal
