#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/analysed_device.hpp"
#include "results/units.hpp"
#include "zwidth/design/design.hpp"

namespace zwidth::report {

/// A device with what each of its numbers does to its critical stiffness, the input of every report of a design.
struct DesignedDevice {
  AnalysedDevice analysed;
  std::vector<Sensitivity> sensitivities;  ///< of K_CR
  std::vector<Sensitivity> any_user;       ///< of the any-user limit; empty where there is none
  /// Of K_CR; absent above most_bodies_for_branch_switches.
  std::optional<std::vector<BranchSwitch>> branch_switches;
};

/// Throws Error (did_not_converge) as its parts do.
[[nodiscard]] DesignedDevice designed_device(Device device);

using results::parameter_unit;

/// A parameter's value with its unit: "0.3 kg", "250 µs".
[[nodiscard]] std::string parameter_text(const std::string& key, double value, Motion motion);

}  // namespace zwidth::report
