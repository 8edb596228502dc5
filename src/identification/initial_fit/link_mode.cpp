#include "identification/initial_fit/link_mode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace zwidth::internal {

double reduced_mass(const DeviceParameters& device, const Link& link) {
  const double first = device.bodies[link.first].mass;
  const double second = device.bodies[link.second].mass;
  return first * second / (first + second);
}

double link_damping(const DeviceParameters& device, const Link& link, double damping_ratio) {
  return 2.0 * damping_ratio * std::sqrt(link.stiffness * reduced_mass(device, link));
}

std::optional<DeviceParameters> with_springs(const DeviceParameters& device, const std::vector<std::string>& free,
                                             double w) {
  const auto is_free = [&](std::size_t link, const char* what) {
    return std::ranges::count(free, fmt::format("link.{}.{}", link, what)) > 0;
  };
  constexpr double hardly_springs = 1.0;  // damping ratio
  DeviceParameters other = device;
  bool is_changed = false;
  for (std::size_t i = 0; i < other.links.size(); ++i) {
    Link& link = other.links[i];
    if (!is_free(i, "stiffness") || !is_free(i, "damping")) continue;
    if (link.damping < link_damping(other, link, hardly_springs)) continue;
    link.stiffness = w * w * reduced_mass(other, link);
    link.damping = link_damping(other, link, typical_damping_ratio);
    is_changed = true;
  }
  if (!is_changed) return std::nullopt;
  other.uncertainty.reset();
  return other;
}

}  // namespace zwidth::internal
