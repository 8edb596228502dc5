#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/model/device_variants.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/holding.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// One of several ways to build a device, judged with three users: none, any passive one, and a given one.
struct ComparedDesign {
  std::string value;                               ///< of the key that is compared
  Device device;                                   ///< without the user
  CriticalStiffness free;                          ///< nobody holding
  std::optional<AbsoluteStabilityLimit> any_user;  ///< absent for a transfer function and many bodies
  std::optional<CriticalStiffness> held;           ///< with the user; absent without one
  HoldingLimits limits = {};                       ///< of all three
};

/// Two variants of one user, by falling stiffness.
struct BestDesigns {
  std::size_t best = 0;    ///< index into DesignComparison::designs
  std::size_t second = 0;  ///< the next
  bool as_good = false;    ///< they differ by at most 1e-3: neither is better
  /// `best` without doubt: every design has a limit for that user, and some wall is stable with the best.
  bool is_best_of_all = false;
};

/// Several designs side by side. A user's best designs are absent where fewer than two of them have a limit for it.
struct DesignComparison {
  std::string key;                           ///< "loop.sensed"
  User user;                                 ///< the given one; all 0: none
  std::vector<ComparedDesign> designs;       ///< in the order given
  std::optional<BestDesigns> best_free;      ///< the stiffest with nobody holding; absent where none can be told
  std::optional<BestDesigns> best_any_user;  ///< the stiffest in every passive hand
  std::optional<BestDesigns> best_held;      ///< the stiffest with the user of its file
  Trust trust;                               ///< the worst of the designs'
};

/// Checks: at least one variant; `user` (see compare_designs()) not negative, and of devices with a body to hold.
[[nodiscard]] std::optional<OptionProblem> find_problem(const DeviceVariants& variants,
                                                        const std::optional<User>& user);

/// Judges every variant, its own [operator] replaced by `user`, or by the first one's where there is none:
/// critical_stiffness() of the free and the held device, absolute_stability_limit().
/// Throws Error (invalid_argument) where find_problem(variants, user) finds one, (did_not_converge) as its parts do.
[[nodiscard]] DesignComparison compare_designs(const DeviceVariants& variants, const std::optional<User>& user = {},
                                               const Progress& progress = {});

}  // namespace zwidth
