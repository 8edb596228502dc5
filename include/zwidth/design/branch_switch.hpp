#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/design/sensitivity.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {

/// Where, as one number p of the device moves, another crossover takes over and the gain stops or turns.
struct BranchSwitch {
  std::string key;                  ///< of the number that moves, as in model/parameter.hpp
  double value = 0.0;               ///< p there
  double stiffness = 0.0;           ///< K_CR just before, on the way from the device's own p
  double stiffness_beyond = 0.0;    ///< just beyond: equal, unless a new pair of crossovers is born below; 0: none
                                    ///< stable; infinity: unbounded
  Crossover before;                 ///< the crossover that limits before
  std::optional<Crossover> beyond;  ///< absent where K_CR is not finite beyond
};

/// Where to look for another mechanism taking over.
struct BranchSwitchOptions {
  double factor = 10.0;    ///< p is followed from p / factor to p * factor; > 1
  Progress progress = {};  ///< told how far the work is; ends it by throwing
};

/// For each of stiffness_sensitivities(), the nearest switch as p falls and as p grows, where there is one.
///
/// p moves by equal factors within `factor` and the range that makes a device; from 0, up to `factor` times the p at
/// which the slope would have changed K_CR by itself. The limiting crossover is followed by its frequency: where
/// that jumps (by 2 % or more, however small the step), bisection finds p to 1e-9. A scan: a branch that limits on less
/// than a step (a twelfth of a decade) may be passed over. Each point is solved anew by critical_stiffness().
/// Throws Error (invalid_argument) for a factor that is not above 1, and as critical_stiffness() does.
[[nodiscard]] std::vector<BranchSwitch> branch_switches(const Device& device, BranchSwitchOptions options = {});

}  // namespace zwidth
