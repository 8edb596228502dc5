#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/stability/any_user.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// A value of a key and the device that it makes.
struct DesignVariant {
  std::string value;
  Device device;
};

/// One of several ways to build a device, judged with three users: none, any passive one, and a given one.
struct ComparedDesign {
  std::string value;  ///< of the key that is compared
  Device device;      ///< without the user
  CriticalStiffness free;
  std::optional<AnyUserLimit> any_user;   ///< absent for a transfer function and many bodies
  std::optional<CriticalStiffness> held;  ///< with the user; absent without one
};

/// Two variants of one user, by falling stiffness.
struct BestDesigns {
  std::size_t best = 0;    ///< index into DesignComparison::designs
  std::size_t second = 0;  ///< the next
  bool as_good = false;    ///< they differ by at most 1e-3: neither is better
};

/// Several designs side by side. A user's best designs are absent where fewer than two of them have a limit for it.
struct DesignComparison {
  std::string key;  ///< "loop.sensed"
  Operator user;    ///< the given one; all 0: none
  std::vector<ComparedDesign> designs;
  std::optional<BestDesigns> best_free;
  std::optional<BestDesigns> best_any_user;
  std::optional<BestDesigns> best_held;
  Trust trust;  ///< the worst of the designs'
};

/// Judges every variant, its own [operator] replaced by `user`: critical_stiffness() of the free and the held device,
/// any_user_limit().
/// Requires at least one variant. Throws Error (invalid_argument) for none or an impossible user, (did_not_converge) as
/// its parts do.
[[nodiscard]] DesignComparison compare_designs(std::string key, const std::vector<DesignVariant>& variants,
                                               const Operator& user);

}  // namespace zwidth
