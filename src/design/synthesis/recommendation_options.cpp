#include <cmath>

#include "design/synthesis/margin_wall.hpp"
#include "design/synthesis/notch_search.hpp"
#include "zwidth/design/wall_recommendation.hpp"
#include "zwidth/model/damper_timing.hpp"

namespace zwidth {
using namespace internal;

std::optional<OptionProblem> find_problem(const RecommendationOptions& options, const Device& device) {
  if (auto problem = find_problem(RequiredMargins{options.gain_margin, options.phase_margin})) return problem;
  if (options.quantisation_force &&
      !(*options.quantisation_force > 0.0 && std::isfinite(*options.quantisation_force))) {
    return option_problem("quantisation_force", {.code = ProblemCode::no_positive_quantity,
                                                 .evidence = {{"value", *options.quantisation_force}},
                                                 .subjects = {{"what", "force"}}});
  }
  if (auto problem = find_modal_frequency_uncertainty_problem(options.modal_frequency_uncertainty, device))
    return problem;
  if (options.draws == 0) return option_problem("draws", {.code = ProblemCode::none_asked});
  if (options.goal == WallGoal::critical_damping && !device.has_bodies()) {
    return option_problem("goal", {.code = ProblemCode::critical_damping_without_mass});
  }
  if (options.goal == WallGoal::critical_damping && has_damper_loop(device.loop())) {
    return option_problem("goal", {.code = ProblemCode::damper_loop_not_known});
  }
  return std::nullopt;
}

}  // namespace zwidth
