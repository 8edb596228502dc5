#include "identification/model/added_rival.hpp"

#include "zwidth/quantity.hpp"

namespace zwidth::internal {

std::string_view unit_of(RivalMeasure measure, Motion motion) {
  const Units units = units_of(motion);
  switch (measure) {
    case RivalMeasure::force:
      return units.force;
    case RivalMeasure::damping:
      return units.damping;
    case RivalMeasure::quadratic_damping:
      return motion == Motion::rotary ? "N m s2/rad2" : "N s2/m2";
    case RivalMeasure::stiffness:
      return units.stiffness;
    case RivalMeasure::time:
      return "s";
    case RivalMeasure::length:
      return units.length;
    case RivalMeasure::ratio:
    case RivalMeasure::mixed:
      return "";
  }
  return "";
}

}  // namespace zwidth::internal
