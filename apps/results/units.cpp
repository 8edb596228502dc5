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

Json wall_units(Motion motion) {
  const Units units = units_of(motion);
  return {{"stiffness", units.stiffness}, {"damping", units.damping}};
}

}  // namespace zwidth::results
