#include "results/units.hpp"

#include "zwidth/io/number_with_unit.hpp"

namespace zwidth::results {

std::optional<double> decibels(std::optional<double> value) {
  if (!value || !(*value > 0.0)) return std::nullopt;
  return decibels(*value);
}

std::optional<double> hertz(std::optional<double> frequency) {
  if (!frequency) return std::nullopt;
  return hertz(*frequency);
}

std::string unit_of(Measure measure, Motion motion) {
  std::string unit(si_unit(measure, motion));
  if (const std::size_t square = unit.find("^2"); square != std::string::npos) unit.replace(square, 2, "²");
  return unit;
}

std::string parameter_unit(const std::string& key, Motion motion) {
  if (key == "viscous") return unit_of(Measure::damping, motion);
  if (key == "offset") return unit_of(Measure::force, motion);
  return unit_of(measure_of(key).value_or(Measure::ratio), motion);
}

Json wall_units(Motion motion) {
  const Units units = units_of(motion);
  return {{"stiffness", units.stiffness}, {"damping", units.damping}};
}

}  // namespace zwidth::results
