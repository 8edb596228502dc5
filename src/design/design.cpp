#include "zwidth/design/design.hpp"

#include <algorithm>
#include <cmath>

#include "model/known_structure.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {

std::optional<OptionProblem> find_problem(const DesignOptions& options) {
  if (options.branch_switch_factor > 1.0 && std::isfinite(options.branch_switch_factor)) return std::nullopt;
  return option_problem("branch_switch_factor",
                        {.code = ProblemCode::not_finite_and_above,
                         .evidence = {{"value", options.branch_switch_factor}, {"bound", 1.0}}});
}

Design design(const Device& device, const DesignOptions& options) {
  internal::require_known_structure(device);
  require_valid(find_problem(options));
  Design design;
  internal::StagedProgress stages(options.progress);
  stages.next(0.1);
  design.analysis = analyze(device, {.any_user = options.any_user, .draws = 0, .progress = stages.stage()});
  design.trust = design.analysis.trust;
  design.remarks = design.analysis.remarks;
  if (design.trust.refused()) {
    if (options.branch_switches) design.branch_switches.emplace();
    return design;
  }
  stages.next(0.15);
  design.sensitivities = stiffness_sensitivities(device, design.analysis.critical);
  stages.next(0.2);
  if (const auto& any_user = design.analysis.any_user) {
    design.absolute_stability_sensitivities = absolute_stability_sensitivities(device, *any_user);
    const bool has_limit = any_user->stiffness > 0.0 && std::isfinite(any_user->stiffness);
    if (has_limit && design.absolute_stability_sensitivities.empty() && has_damper_loop(device.loop())) {
      design.remarks.push_back(
          note({.code = FindingCode::left_out_beside_damper_loop, .subjects = {{"what", "any_user_slopes"}}}));
    }
  }
  stages.next(1.0);
  if (!options.branch_switches) return design;
  if (device.degrees_of_freedom() <= most_bodies_for_branch_switches) {
    design.branch_switches = branch_switches(device, {options.branch_switch_factor, stages.stage()});
  } else {
    design.remarks.push_back(note({.code = FindingCode::branch_switches_not_searched,
                                   .evidence = {{"bodies", static_cast<double>(device.degrees_of_freedom())},
                                                {"most", static_cast<double>(most_bodies_for_branch_switches)}}}));
  }
  stages.done();
  return design;
}

const Sensitivity* find_sensitivity(const std::vector<Sensitivity>& sensitivities, const std::string& key) {
  const auto found = std::ranges::find(sensitivities, key, &Sensitivity::key);
  return found == sensitivities.end() ? nullptr : &*found;
}

}  // namespace zwidth
