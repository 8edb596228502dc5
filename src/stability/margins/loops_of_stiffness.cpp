#include "stability/margins/loops_of_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stability/margins/unit_gain.hpp"

namespace zwidth::internal {

LoopsOfStiffness::LoopsOfStiffness(const FilteredPlant& plant, VirtualDamper damper)
    : plant_(plant), damper_(damper), by_stiffness_(stiffness_crossings(plant, damper)) {}

double LoopsOfStiffness::slack(double stiffness, double gain_margin, double phase_margin) const {
  const auto on_crossing = [stiffness](const GainCrossing& each) { return each.gain == stiffness; };
  if (unstable_poles(by_stiffness_, stiffness) != 0 || std::ranges::any_of(by_stiffness_.crossings, on_crossing)) {
    return -1.0;
  }
  double slack = std::numeric_limits<double>::infinity();
  if (phase_margin > 0.0) {
    const Wall wall{stiffness, damper_.damping, damper_.velocity_filter_hz};
    for (const UnitGainPoint& point : unit_gain_points(plant_, wall)) {
      slack = std::min(slack, std::abs(point.phase) / phase_margin - 1.0);
    }
    if (slack < 0.0) return slack;
  }
  // Without a damper the whole force is the stiffness.
  const bool damped = damper_.damping > 0.0;
  const GainCrossings by_force =
      damped ? gain_crossings(plant_, GainLocus(plant_, GainLocus::Gain::wall, stiffness, damper_)) : GainCrossings{};
  for (const GainCrossing& crossing : (damped ? by_force : by_stiffness_).crossings) {
    const double factor = damped ? crossing.gain : crossing.gain / stiffness;
    if (factor > 1.0) slack = std::min(slack, factor / gain_margin - 1.0);
  }
  return slack;
}

}  // namespace zwidth::internal
