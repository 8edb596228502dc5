#pragma once

// Coordinates z of a device of coordinates, q = S z, in which M is 1 and what no spring stretches stands apart.

#include <Eigen/Core>

#include "model/device_lengths.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

struct NormalCoordinates {
  Eigen::MatrixXd shapes;  // S; S' M S = 1
  Eigen::Index free = 0;   // the first ones: no spring holds them, nor the user's
  Eigen::Index loose = 0;  // how many of the free motions no damper holds either
  Eigen::MatrixXd damped;  // orthonormal columns: the free motions that dampers hold
  Eigen::MatrixXd stiffness;
  Eigen::MatrixXd damping;

  // S' w
  [[nodiscard]] Eigen::VectorXd of(const Weights& weights) const;
};

// The user included. `device` has coordinates.
[[nodiscard]] NormalCoordinates normal_coordinates(const Device& device);

// A turn of the free motions: first those that positions, one a row in those coordinates, do not show.
struct UnseenFirst {
  Eigen::MatrixXd turn;     // orthogonal, n x n
  Eigen::Index unseen = 0;  // the first of the free ones
  Eigen::Index adrift = 0;  // the first of those: no damper holds them either
};
[[nodiscard]] UnseenFirst unseen_first(const NormalCoordinates& of, const Eigen::MatrixXd& positions);

// Poles at s = 0 that a path sees. A force b moves free motions by sum v_i (v_i' b) / (s (d_i + s)) over the eigenvectors of
// their damping, d_i its eigenvalues: two where those of d_i = 0 are both pushed and seen, one where others are.
[[nodiscard]] std::size_t poles_at_zero_seen(const NormalCoordinates& of, const Weights& force_at,
                                             const Weights& position_of);

}  // namespace zwidth::internal
