#include "design/synthesis/bounded_stiffness.hpp"

#include <algorithm>
#include <numbers>

#include "design/synthesis/margin_wall.hpp"
#include "design/synthesis/wall_limits.hpp"
#include "infinity.hpp"
#include "staged_progress.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth::internal {
namespace {

constexpr double rounding_of_margins = 1e-9;  // of margins that stand exactly at what is required
constexpr double same_margin = 1e-4;          // relative, of a margin that is the one that bounds

LoopMargins margins_of(const FilteredPlant& plant, double stiffness, VirtualDamper damper) {
  Wall wall;
  wall.stiffness = stiffness;
  wall.damping = damper.damping;
  wall.velocity_filter_hz = damper.velocity_filter_hz;
  return loop_margins(plant, wall);
}

}  // namespace

void bound_by_quantisation(const Device& device, double period, VirtualDamper damper,
                           const RecommendationOptions& options, BoundedStiffness& least) {
  const double resolution = device.parameters().sensor.resolution;
  if (!options.quantisation_force || !(resolution > 0.0)) return;
  const Wall wall = with_wall(device, 0.0, damper).parameters().wall;
  const ForcePerCountRates rates = force_per_count_rates(wall, period, resolution);
  least.lower_to(std::max(0.0, *options.quantisation_force - damper.damping * rates.per_damping) / rates.per_stiffness,
                 WallBound::quantisation_force);
}

void bound_by_margins(const std::vector<FilteredPlant>& plants, VirtualDamper damper,
                      const RecommendationOptions& options, BoundedStiffness& least) {
  if (keeps_margins(plants, least.stiffness, damper, options)) return;
  const RequiredMargins required{options.gain_margin, options.phase_margin, false};
  for (const FilteredPlant& plant : plants) {
    const double kept = stiffest_wall(plant, damper, required, {.at_most = least.stiffness}, options.progress);
    least.stiffness = std::min(least.stiffness, kept * (1.0 - off_every_limit));
  }
  const bool phase =
      least.stiffness == 0.0 || std::ranges::any_of(plants, [&](const FilteredPlant& plant) {
        const LoopMargins has = margins_of(plant, least.stiffness, damper);
        return has.phase_margin && *has.phase_margin <= options.phase_margin * (1.0 + same_margin) + off_every_limit;
      });
  least.bound = phase ? WallBound::phase_margin : WallBound::gain_margin;
  if (least.stiffness > 0.0 && !keeps_margins(plants, least.stiffness, damper, options)) least.stiffness = 0.0;
}

bool keeps_margins(const std::vector<FilteredPlant>& plants, double stiffness, VirtualDamper damper,
                   const RecommendationOptions& options) {
  tell(options.progress, 0.0);
  const double least_gain = options.gain_margin * (1.0 - rounding_of_margins);
  return std::ranges::all_of(plants, [&](const FilteredPlant& plant) {
    const LoopMargins has = margins_of(plant, stiffness, damper);
    return has.stable && has.gain_margin.value_or(infinity) >= least_gain &&
           has.stiffness_margin.value_or(infinity) >= least_gain &&
           has.lower_gain_margin.value_or(0.0) * options.gain_margin <= 1.0 + rounding_of_margins &&
           has.phase_margin.value_or(std::numbers::pi) >= options.phase_margin * (1.0 - rounding_of_margins);
  });
}

}  // namespace zwidth::internal
