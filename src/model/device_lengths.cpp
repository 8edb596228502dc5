#include "model/device_lengths.hpp"

#include "zwidth/model/mechanism_key.hpp"

namespace zwidth::internal {
namespace {

Weights without_zeros(const std::vector<double>& weights) {
  Weights result;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] != 0.0) result.push_back({i, weights[i]});
  }
  return result;
}

}  // namespace

Weights weights_of(const Device& device, std::size_t point) {
  if (device.has_bodies()) return {{point, 1.0}};
  require_one_direction(device);  // its points are no answer: a loop of one direction would be computed from them
  return without_zeros(device.parameters().coordinates->points[point].weights);
}

std::size_t points_of(const Device& device) {
  return device.has_bodies() ? device.bodies().size() : device.parameters().coordinates->points.size();
}

std::vector<DeviceLength> lengths_of(const Device& device) {
  std::vector<DeviceLength> lengths;
  if (!device.has_bodies()) {
    for (const auto& [weights, stiffness, damping] : device.parameters().coordinates->elements) {
      lengths.push_back({without_zeros(weights), stiffness, damping});
    }
    return lengths;
  }
  for (std::size_t i = 0; i < device.bodies().size(); ++i) {
    const Body& body = device.bodies()[i];
    if (body.stiffness > 0.0 || body.damping > 0.0) lengths.push_back({{{i, 1.0}}, body.stiffness, body.damping});
  }
  for (const Link& link : device.links()) {
    lengths.push_back({{{link.first, 1.0}, {link.second, -1.0}}, link.stiffness, link.damping});
  }
  return lengths;
}

}  // namespace zwidth::internal
