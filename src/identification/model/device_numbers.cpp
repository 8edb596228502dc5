#include "identification/model/device_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "model/loop_keys.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {

Number device_number(const std::string& key, const DeviceParameters& start, const TypicalSizes& typical) {
  constexpr double of_critical = 0.01;  // a link's damping, of the square root of stiffness times mass
  constexpr double small = 1e-3;        // of the typical stiffness
  const double value = *parameter(start, key);
  const bool is_of_link = key.starts_with("link.");
  if (key.ends_with(".mass") || (is_of_link && key.ends_with(".stiffness"))) {
    return {key, Number::Scale::logarithmic, value, 0.0, deviation_of_logarithm};
  }
  if (key == key_of_delay) return {.key = key, .unit = typical.time};
  if (key.ends_with(".damping") && !is_of_link) return {.key = key, .unit = typical.damping};
  if (key.ends_with(".damping")) {
    const Link& link = start.links[static_cast<std::size_t>(std::stoul(key.substr(std::string_view("link.").size())))];
    const double damping = of_critical * std::sqrt(link.stiffness * start.bodies[link.second].mass);
    return {.key = key, .unit = std::max(value, damping)};
  }
  return {.key = key, .unit = std::max(value, small * typical.stiffness)};
}

Number number_about(const std::string& key, double value, double deviation) {
  return {key, Number::Scale::logarithmic, value, 0.0, deviation};
}

}  // namespace zwidth::internal
