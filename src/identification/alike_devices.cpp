#include "identification/alike_devices.hpp"

#include <algorithm>
#include <cmath>

namespace zwidth::internal {
namespace {

bool are_open(const DeviceParameters& device, const std::vector<std::string>& free) {
  const auto is_free = [&](const std::string& key) { return std::ranges::count(free, key) > 0; };
  return is_free("link.0.stiffness") && is_free("link.0.damping") &&
         std::ranges::all_of(device.bodies, [&](const Body& body) {
           return body.stiffness == 0.0 && is_free("body." + body.name + ".mass") &&
                  is_free("body." + body.name + ".damping");
         });
}

}  // namespace

std::vector<DeviceParameters> alike_devices(const DeviceParameters& device, const std::vector<std::string>& free) {
  if (device.bodies.size() != 2 || device.links.size() != 1 || device.loop.actuated == device.loop.sensed) return {};
  if (!are_open(device, free)) return {};
  const Body& first = device.bodies[0];
  const Body& second = device.bodies[1];
  const double mass = first.mass + second.mass;
  const double product = first.mass * second.mass;
  const double damping = first.damping + second.damping;
  const double rates = first.damping / first.mass + second.damping / second.mass;
  std::vector<DeviceParameters> alike;
  for (const double share : {0.15, 0.5, 0.85}) {  // of the first body
    DeviceParameters each = device;
    Body& one = each.bodies[0];
    Body& other = each.bodies[1];
    one.mass = share * mass;
    other.mass = mass - one.mass;
    // b_1/m_1 + b_2/m_2 = rates, as far as both are >= 0.
    const double difference = 1.0 / one.mass - 1.0 / other.mass;
    one.damping = std::abs(difference) * mass > 1e-6
                      ? std::clamp((rates - damping / other.mass) / difference, 0.0, damping)
                      : 0.5 * damping;
    other.damping = damping - one.damping;
    each.links[0].stiffness *= one.mass * other.mass / product;
    each.links[0].damping *= one.mass * other.mass / product;
    alike.push_back(std::move(each));
  }
  return alike;
}

}  // namespace zwidth::internal
