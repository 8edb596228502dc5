#pragma once

#include <string>

#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/holding.hpp"

namespace zwidth {

/// What a critical stiffness says of its holder; the largest damper alone is left out.
[[nodiscard]] inline HolderLimit limit_of_holder(const CriticalStiffness& critical) {
  HolderLimit limit{.critical_stiffness = critical.stiffness};
  if (critical.limit) {
    limit.frequency = critical.limit->frequency;
    limit.limited_by = critical.limit->limited_by;
  }
  return limit;
}

/// With whom an unstable wall is: "with nobody holding", "with the file's user", "with nobody holding and with the file's
/// user"; empty where it is stable with both.
[[nodiscard]] std::string unstable_with(const StableFor& wall);

}  // namespace zwidth
