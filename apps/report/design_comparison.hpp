#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/stability/any_user.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::report {

/// One of several ways to build a device, judged with three users: none, any passive one, and a given one.
struct ComparedDesign {
  std::string value;  ///< of the key that is compared
  Device device;
  CriticalStiffness free;                 ///< without the user
  std::optional<AnyUserLimit> any_user;   ///< absent for a transfer function and many bodies
  std::optional<CriticalStiffness> held;  ///< with the user; absent without one
};

struct DesignComparison {
  std::string key;  ///< "loop.sensed"
  Operator user;    ///< the given one; all 0: none
  std::vector<ComparedDesign> designs;
};

/// A value of the key and the device that it makes.
struct Variant {
  std::string value;
  Device device;
};

/// Judges every variant, its own [operator] replaced by `user`. Throws Error (did_not_converge) as its parts do,
/// (invalid_argument) for an impossible user.
[[nodiscard]] DesignComparison compare_designs(std::string key, const std::vector<Variant>& variants,
                                               const Operator& user);

/// A row per variant, and a sentence per user that says which is better.
[[nodiscard]] std::string comparison_text(const DesignComparison& comparison);

}  // namespace zwidth::report
