#pragma once

// M x'' + D x' + K x = f of a device of bodies, its user included. One home for the assembly.

#include <cstddef>
#include <tuple>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

template <typename Real>
struct DeviceMatrices {
  std::vector<Real> mass;       // diagonal
  std::vector<Real> damping;    // n x n, row by row
  std::vector<Real> stiffness;  // n x n
};

template <typename Real>
DeviceMatrices<Real> device_matrices(const Device& device) {
  const std::size_t n = device.bodies().size();
  const User& user = device.parameters().user;
  DeviceMatrices<Real> matrices{std::vector<Real>(n, Real(0.0)), std::vector<Real>(n * n, Real(0.0)),
                                std::vector<Real>(n * n, Real(0.0))};
  for (std::size_t i = 0; i < n; ++i) {
    const Body& body = device.bodies()[i];
    matrices.mass[i] += Real(body.mass);
    matrices.damping[i * n + i] += Real(body.damping);
    matrices.stiffness[i * n + i] += Real(body.stiffness);
  }
  const std::size_t held = device.loop().held;
  matrices.mass[held] += Real(user.mass);
  matrices.damping[held * n + held] += Real(user.damping);
  matrices.stiffness[held * n + held] += Real(user.stiffness);
  for (const Link& link : device.links()) {
    for (const auto& [i, j, sign] :
         {std::tuple{link.first, link.first, 1.0}, std::tuple{link.second, link.second, 1.0},
          std::tuple{link.first, link.second, -1.0}, std::tuple{link.second, link.first, -1.0}}) {
      matrices.damping[i * n + j] += Real(sign * link.damping);
      matrices.stiffness[i * n + j] += Real(sign * link.stiffness);
    }
  }
  return matrices;
}

}  // namespace zwidth::internal
