#include "results/units.hpp"

namespace zwidth::results {

std::optional<double> decibels(std::optional<double> value) {
  if (!value || !(*value > 0.0)) return std::nullopt;
  return decibels(*value);
}

std::optional<double> hertz(std::optional<double> frequency) {
  if (!frequency) return std::nullopt;
  return hertz(*frequency);
}

std::string parameter_unit(const std::string& key, Motion motion) {
  const Units units = units_of(motion);
  if (key.ends_with("mass")) return std::string(units.mass);
  if (key.ends_with(".damping") || key == "viscous") return std::string(units.damping);
  if (key.ends_with(".stiffness")) return std::string(units.stiffness);
  if (key.ends_with("coulomb") || key == "offset") return std::string(units.force);
  if (key.ends_with("_hz")) return "Hz";
  if (key.starts_with("loop.") || key == "actuator.time_constant" || key == "delay") return "s";
  return {};
}

Json wall_units(Motion motion) {
  const Units units = units_of(motion);
  return {{"stiffness", units.stiffness}, {"damping", units.damping}};
}

}  // namespace zwidth::results
