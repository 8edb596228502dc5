#pragma once

#include <string>

#include "results/json.hpp"
#include "zwidth/design/design.hpp"
#include "zwidth/design/design_comparison.hpp"
#include "zwidth/design/notch_design.hpp"
#include "zwidth/design/parameter_sweep.hpp"

namespace zwidth::results {

NLOHMANN_JSON_SERIALIZE_ENUM(StiffnessGoal, {{StiffnessGoal::critical_stiffness, "critical_stiffness"},
                                             {StiffnessGoal::absolute_stability_limit, "any_user_limit"}})

/// The answer of `design --json`, schema zwidth.design/1 (docs/design.md).
[[nodiscard]] Json design_json(const Device& device, const Design& design);

/// The answer of `design --sweep --json`, schema zwidth.design_sweep/1.
[[nodiscard]] Json sweep_json(const Device& device, const ParameterSweep& sweep);

/// Every point, a line each: the parameters, K_CR (empty where unbounded), rad/s, mode (0: the rigid body), the
/// absolute stability limit where asked for.
[[nodiscard]] std::string sweep_csv(const ParameterSweep& sweep);

/// The answer of `design --compare --json`, schema zwidth.design_comparison/1.
[[nodiscard]] Json comparison_json(const DesignComparison& comparison);

/// The answer of `design --notch --json`, schema zwidth.notch/1.
[[nodiscard]] Json notch_json(const Device& device, const NotchOptions& options, const NotchDesign& notch);

}  // namespace zwidth::results
