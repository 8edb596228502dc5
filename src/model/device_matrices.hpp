#pragma once

// M x'' + D x' + K x = f of a device of bodies or coordinates, its user included. One home for the assembly.

#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include "model/device_lengths.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

template <typename Real>
struct DeviceMatrices {
  std::vector<Real> mass;       // diagonal
  std::vector<Real> coupling;   // of coordinates what else the mass matrix has, n x n; empty of bodies
  std::vector<Real> damping;    // n x n, row by row
  std::vector<Real> stiffness;  // n x n
};

// sum += factor w w', row by row.
template <typename Real>
void add_product(std::vector<Real>& sum, std::size_t n, const Weights& weights, double factor) {
  if (factor == 0.0) return;
  for (const auto& [i, of_i] : weights) {
    for (const auto& [j, of_j] : weights) sum[i * n + j] += Real(factor) * Real(of_i) * Real(of_j);
  }
}

template <typename Real>
void add_coordinates(DeviceMatrices<Real>& matrices, const Device& device) {
  const std::size_t n = device.degrees_of_freedom();
  const User& user = device.parameters().user;
  matrices.coupling.assign(n * n, Real(0.0));
  for (std::size_t i = 0; i < n * n; ++i) matrices.coupling[i] += Real(device.parameters().coordinates->mass[i]);
  const Weights held = weights_of(device, device.loop().held);
  add_product(matrices.coupling, n, held, user.mass);
  add_product(matrices.damping, n, held, user.damping);
  add_product(matrices.stiffness, n, held, user.stiffness);
  for (const DeviceLength& each : lengths_of(device)) {
    add_product(matrices.damping, n, each.weights, each.damping);
    add_product(matrices.stiffness, n, each.weights, each.stiffness);
  }
  for (std::size_t i = 0; i < n; ++i) std::swap(matrices.mass[i], matrices.coupling[i * n + i]);
}

template <typename Real>
DeviceMatrices<Real> device_matrices(const Device& device) {
  const std::size_t n = device.degrees_of_freedom();
  const User& user = device.parameters().user;
  DeviceMatrices<Real> matrices{
      std::vector<Real>(n, Real(0.0)), {}, std::vector<Real>(n * n, Real(0.0)), std::vector<Real>(n * n, Real(0.0))};
  if (!device.has_bodies()) {
    add_coordinates(matrices, device);
    return matrices;
  }
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
