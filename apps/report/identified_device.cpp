#include "report/identified_device.hpp"

#include "report/text/quantity.hpp"

namespace zwidth::report {

std::string_view unit_of_parameter(std::string_view key, Motion motion) {
  const Units units = units_of(motion);
  if (key.ends_with("mass")) return units.mass;
  if (key.ends_with(".damping") || key == "viscous") return units.damping;
  if (key.ends_with(".stiffness")) return units.stiffness;
  if (key == "coulomb" || key == "offset") return units.force;
  return "s";  // a delay, actuator.time_constant
}

}  // namespace zwidth::report
