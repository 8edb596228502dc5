#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/design/branch_switch.hpp"
#include "zwidth/design/sensitivity.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// Every number is followed through dozens of devices: with more bodies that would take minutes.
inline constexpr std::size_t most_bodies_for_branch_switches = 8;

/// What a design answers beside the slopes of K_CR.
struct DesignOptions {
  bool any_user = true;              ///< the absolute stability limit and its slopes, where analyze() gives that limit
  bool branch_switches = true;       ///< where another crossover takes over; a device of at most 8 bodies
  double branch_switch_factor = 10;  ///< each number is followed from p / factor to p * factor; > 1, finite
  Progress progress = {};            ///< told how far the work is; ends it by throwing
};

/// Checks the factor.
[[nodiscard]] std::optional<OptionProblem> find_problem(const DesignOptions& options);

/// What each number of a device does to the stiffest wall.
struct Design {
  Analysis analysis;                       ///< of the device as it is
  std::vector<Sensitivity> sensitivities;  ///< of K_CR
  std::vector<Sensitivity>
      absolute_stability_sensitivities;  ///< of the absolute stability limit; empty where there is none
  /// Where another crossover sets K_CR; absent above most_bodies_for_branch_switches, and where not asked for; empty
  /// where there is no limit.
  std::optional<std::vector<BranchSwitch>> branch_switches;
  Trust trust;                  ///< the analysis'; nothing else is held where it is refused
  std::vector<Remark> remarks;  ///< the analysis', and what was left out here
};

/// The slopes of both limits and the places where another mechanism takes over.
///
///     dK_CR/dp, p/K dK_CR/dp of stiffness_sensitivities() and absolute_stability_sensitivities(); branch_switches()
///
/// Throws Error (invalid_argument) where find_problem(options) finds one, (did_not_converge) as its parts do.
[[nodiscard]] Design design(const Device& device, const DesignOptions& options = {});

/// The sensitivity of that key, or nullptr.
[[nodiscard]] const Sensitivity* find_sensitivity(const std::vector<Sensitivity>& sensitivities,
                                                  const std::string& key);

}  // namespace zwidth
